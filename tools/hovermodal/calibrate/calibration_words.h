#pragma once

#include <string>
#include <vector>

#include "core/geometry/camera_fit.h"

namespace tools {

// A finished calibration: the data for text and picture.
struct CalibrationRun {
  core::ChessBoard board;
  int width_px = 0, height_px = 0;
  std::vector<core::BoardView> views;  // those fitted
  std::vector<std::string> places;     // per view
  std::vector<std::string> dropped;    // views left out because their corners do not fit, with the reason
  std::size_t n_looked_at = 0, n_found = 0;
  core::CameraFit fit;
};

// What was done, the parameters with their standard deviations, coverage of the image, and warnings. Ends in a newline.
[[nodiscard]] std::string calibration_words(const CalibrationRun& run);

// Camera, standard deviations, views and doubts; `out`: the file that was written.
[[nodiscard]] std::string calibration_json(const CalibrationRun& run, const std::string& out);

// Doubts about the result, each with its remedy; empty = none.
[[nodiscard]] std::vector<std::string> calibration_warnings(const CalibrationRun& run);

// Corners per ninth of the image, row by row from the top left.
[[nodiscard]] std::vector<int> corners_per_ninth(const CalibrationRun& run);

// The corners and their residuals over the image, as SVG.
[[nodiscard]] std::string calibration_svg(const CalibrationRun& run);

}  // namespace tools
