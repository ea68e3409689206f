#pragma once

#include <vector>

namespace drivers {

// Camera nodes (video, media, v4l-subdev) which this process still holds open although they are gone from /dev: their
// device was unplugged. Looks through the process's open files: not for a frame's path.
[[nodiscard]] std::vector<int> open_nodes_that_are_gone();

// Lets go of the device behind each descriptor; the descriptor itself stays taken, on /dev/null, so that an owner that
// closes it later closes no one else's.
void let_go(const std::vector<int>& descriptors) noexcept;

}  // namespace drivers
