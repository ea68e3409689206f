#pragma once

#include <map>
#include <string>

namespace tools {

struct ImagePlace {
  double u_px = 0.0, v_px = 0.0;
};

// Middle of the points of every region in the first frame of a tracks.csv; reads no further. Throws drivers::FileError
// naming the line.
[[nodiscard]] std::map<std::string, ImagePlace> keyframe_places(const std::string& tracks_path);

}  // namespace tools
