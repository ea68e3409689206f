#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>

#include "core/geometry/lens_fault.h"
#include "drivers/storage/calibration_file.h"

namespace drivers {
namespace {

std::string matrix_text(const char* key, std::size_t rows, std::size_t cols, std::span<const double> values) {
  return fmt::format("{}: !!opencv-matrix\n   rows: {}\n   cols: {}\n   dt: d\n   data: [ {} ]\n", key, rows, cols,
                     fmt::join(values, ", "));
}

// The number that OpenCV would write: 4, 5 or 8.
std::size_t n_coefficients(const core::CameraModel& camera) {
  if (camera.lens == core::LensModel::kEquidistant) return 4;
  const auto& k = camera.distortion;
  return k[5] != 0.0 || k[6] != 0.0 || k[7] != 0.0 ? 8 : 5;
}

}  // namespace

std::string calibration_fault(const core::CameraModel& camera, int width_px, int height_px) {
  for (const double focal : {camera.fx, camera.fy}) {
    if (!(focal >= 1.0 && focal <= 1e6))
      return fmt::format("focal length {} is refused: allowed 1 .. 1000000 (px); calibrate again", focal);
  }
  for (const double centre : {camera.cx, camera.cy}) {
    if (!(std::abs(centre) <= 1e6))
      return fmt::format("principal point {} is refused: allowed within 1000000 px; calibrate again", centre);
  }
  if (width_px <= 0 || height_px <= 0) return {};
  if (camera.cx < 0.0 || camera.cy < 0.0 || camera.cx > width_px - 1.0 || camera.cy > height_px - 1.0) {
    return fmt::format(
        "principal point ({}, {}) is refused: allowed inside the image of {} x {} px; calibrate the images that are "
        "used, uncropped",
        camera.cx, camera.cy, width_px, height_px);
  }
  const auto fold = core::lens_fault(camera, width_px, height_px);
  if (!fold) return {};
  return fmt::format(
      "the distortion folds the image: {:.0f} px from the principal point (pixel {:.0f}, {:.0f}; {:.0f} degrees off "
      "the "
      "axis) two rays fall on one place; calibrate with the board filmed into the corners, or with fewer coefficients",
      fold->radius_px, fold->raw_px.u, fold->raw_px.v, fold->angle_deg);
}

// Pixel centres lie at whole numbers, so the image's edge lies at -0.5.
core::CameraModel scaled_camera(const Calibration& calibration, int width_px) {
  core::CameraModel out = calibration.camera;
  const double share = static_cast<double>(width_px) / calibration.width_px;
  out.fx *= share;
  out.fy *= share;
  out.cx = share * (out.cx + 0.5) - 0.5;
  out.cy = share * (out.cy + 0.5) - 0.5;
  return out;
}

std::string calibration_text(const Calibration& calibration, const CalibrationNotes& notes) {
  const core::CameraModel& camera = calibration.camera;
  const bool equidistant = camera.lens == core::LensModel::kEquidistant;
  const std::size_t n = n_coefficients(camera);
  const double k[9] = {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
  std::string out = "%YAML:1.0\n---\n";
  const auto append = [&out]<class... Args>(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(out), format, std::forward<Args>(args)...);
  };
  append("image_width: {}\nimage_height: {}\n", calibration.width_px, calibration.height_px);
  append("board_width: {}\nboard_height: {}\nsquare_size: {}\n", notes.board_columns, notes.board_rows,
         notes.square_mm);
  append("nr_of_frames: {}\n", notes.n_views);
  append("fisheye_model: {}\ndistortion_model: {}\n", equidistant ? 1 : 0,
         equidistant ? "equidistant" : (n == 8 ? "rational_polynomial" : "plumb_bob"));
  out += matrix_text("camera_matrix", 3, 3, k);
  out += matrix_text("distortion_coefficients", n, 1, std::span(camera.distortion).first(n));
  append("avg_reprojection_error: {}\n", calibration.rms_px);
  if (!notes.sigma.empty()) {
    out += "# standard deviations of fx fy cx cy and of the coefficients, px and 1\n";
    out += matrix_text("standard_deviations", notes.sigma.size(), 1, notes.sigma);
  }
  return out;
}

}  // namespace drivers
