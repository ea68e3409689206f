#pragma once

#include <string>
#include <vector>

#include "core/geometry/camera_model.h"

namespace drivers {

// A camera and its lens, as written by calibration programs. In pixels of the raw image.
struct Calibration {
  core::CameraModel camera;
  int width_px = 0, height_px = 0;  // of the calibrated image; 0 = unknown
  double rms_px = 0.0;              // reprojection error; 0 = not stated
};

// Reads a Kalibr camchain (one camera), an OpenCV FileStorage YAML or a ROS camera_info YAML, recognised by their
// the content. Distortion: radial-tangential with 4 or 5 coefficients, rational with 8, equidistant with 4, none.
// Throws FileError (drivers/storage/text_file.h) with file, line, key, value and remedy; other models (omni, double
// sphere, fov, thin prism, tilt, equirectangular) and faults found by calibration_fault() are refused.
[[nodiscard]] Calibration read_calibration(const std::string& path);
[[nodiscard]] Calibration parse_calibration(const std::string& text, const std::string& name);

// Why a camera does not fit an image of this size: focal length, principal point outside, distortion that folds it.
// Includes the remedy; empty: it fits.
[[nodiscard]] std::string calibration_fault(const core::CameraModel& camera, int width_px, int height_px);

// The camera of `calibration` if its whole image were scaled to this width.
[[nodiscard]] core::CameraModel scaled_camera(const Calibration& calibration, int width_px);

// Further results of a calibration by this program.
struct CalibrationNotes {
  int board_columns = 0, board_rows = 0;  // inner corners
  double square_mm = 0.0;
  int n_views = 0;
  std::vector<double> sigma;  // of fx fy cx cy and the coefficients; empty = unknown
};

// OpenCV's format, as `hovermodal calibrate` writes it and read_calibration() reads it back to the last bit.
[[nodiscard]] std::string calibration_text(const Calibration& calibration, const CalibrationNotes& notes);

}  // namespace drivers
