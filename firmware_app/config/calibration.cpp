#include "firmware_app/config/calibration.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

#include "drivers/storage/calibration_file.h"

namespace app {
namespace {

[[noreturn]] void refuse_resolution(const std::string& name, const drivers::Calibration& file,
                                    const core::CameraInfo& camera) {
  std::string text = fmt::format(
      "calibration.file: {} is for {} x {} px, the camera gives {} x {} px; calibrate this mode of the "
      "camera",
      name, file.width_px, file.height_px, camera.width_px, camera.height_px);
  const double wide = static_cast<double>(file.width_px) * camera.height_px;
  const double high = static_cast<double>(file.height_px) * camera.width_px;
  // Rounding to whole pixels may change either side by half a pixel.
  if (std::abs(wide - high) <= 0.5 * (file.width_px + file.height_px)) {
    const core::CameraModel scaled = drivers::scaled_camera(file, camera.width_px);
    text += fmt::format(
        ". If it shows the same field of view, only in other pixels, then fx {:.2f} fy {:.2f} cx {:.2f} cy {:.2f} with "
        "the same distortion would be right (many cameras crop instead: compare two pictures first)",
        scaled.fx, scaled.fy, scaled.cx, scaled.cy);
  } else {
    text += "; the shapes differ, so one is a crop of the other, and which part is not known";
  }
  throw ConfigError(text);
}

// Points of a region outside the lens's field have no undistorted positions.
void require_regions_undistort(const AppConfig& config, const core::CameraModel& camera, const std::string& source) {
  for (std::size_t i = 0; i < config.regions.size(); ++i) {
    const core::Region& r = config.regions[i];
    const double right = r.u_px + r.width_px;
    const double bottom = r.v_px + r.height_px;
    const std::array<core::Vector2, 4> corners{{{r.u_px, r.v_px}, {right, r.v_px}, {r.u_px, bottom}, {right, bottom}}};
    for (const core::Vector2& corner : corners) {
      const core::Vector2 ideal = camera.undistort(corner);
      if (std::isfinite(ideal.u) && std::isfinite(ideal.v)) continue;
      throw ConfigError(fmt::format(
          "regions.{}.rect: its corner ({}, {}) is refused: allowed less than 90 degrees off the axis of {}; region "
          "`{}` cannot be undistorted: move it inwards",
          i, corner.u, corner.v, source, r.name));
    }
  }
}

}  // namespace

core::CameraModel camera_model(const AppConfig& config, const core::CameraInfo& camera) {
  const CalibrationConfig& values = config.calibration;
  core::CameraModel model{values.fx, values.fy, values.cx, values.cy, values.distortion, values.model};
  std::string source = "calibration";
  if (!values.file.empty()) {
    source = "calibration.file: " + values.file;
    const drivers::Calibration file = drivers::read_calibration(values.file);
    if (file.width_px != 0 && (file.width_px != camera.width_px || file.height_px != camera.height_px))
      refuse_resolution(values.file, file, camera);
    model = file.camera;
  }
  if (!model.calibrated()) return model;
  const std::string fault = drivers::calibration_fault(model, camera.width_px, camera.height_px);
  if (!fault.empty()) throw ConfigError(source + ": " + fault);
  require_regions_undistort(config, model, source);
  return model;
}

}  // namespace app
