#pragma once

#include <string>
#include <vector>

namespace drivers {

// A pinhole camera with radial-tangential distortion, as calibration programs write it. Pixels of the raw image.
struct Calibration {
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;
  std::string model;                // "pinhole-radtan"
  std::vector<double> distortion;   // k1 k2 p1 p2 [k3]: 4 or 5 values
  int width_px = 0, height_px = 0;  // of the calibrated image; 0 = unknown
};

// Reads a Kalibr camchain (one camera), an OpenCV FileStorage YAML or a ROS camera_info YAML; which one it is shows in
// the content. Throws FileError (drivers/storage/text_file.h) with file, line and what to do; other models are refused.
[[nodiscard]] Calibration read_calibration(const std::string& path);
[[nodiscard]] Calibration parse_calibration(const std::string& text, const std::string& name);

}  // namespace drivers
