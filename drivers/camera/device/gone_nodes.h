#pragma once

#include <vector>

namespace drivers {

// Camera nodes (video, media, v4l-subdev) that this process holds open, and those of them that are gone from /dev,
// because their device was unplugged. Searches the process's open files: not for the path of a frame.
[[nodiscard]] std::vector<int> open_camera_nodes();
[[nodiscard]] std::vector<int> open_nodes_that_are_gone();

// Releases the device behind each descriptor. The descriptor itself remains in use, on /dev/null, so that an owner that
// closes it later does not close another file.
void let_go(const std::vector<int>& descriptors) noexcept;

}  // namespace drivers
