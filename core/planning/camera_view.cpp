#include "core/planning/camera_view.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "core/geometry/rolling_shutter.h"
#include "core/planning/check_value.h"

namespace core::planning {

void validate(const PlannedCamera& camera) {
  require_range("image width (px)", camera.width_px, 16, 32768);
  require_range("image height (px)", camera.height_px, 16, 32768);
  require_range("focal length (px)", camera.focal_px, 1.0, 1e6);
  require_range("frame rate (Hz)", camera.rate_hz, 0.1, 1e5);
  const double period_ms = 1e3 / camera.rate_hz;
  require(std::abs(camera.readout_s) * 1e3 <= period_ms * (1.0 + 1e-9), "readout (ms)", camera.readout_s * 1e3,
          "a frame is not read longer than until the next one: at most 1000 / frame rate, to either side of 0");
  require(camera.exposure_s >= 0.0 && camera.exposure_s * 1e3 <= period_ms * (1.0 + 1e-9), "exposure (ms)",
          camera.exposure_s * 1e3, "give 0 to 1000 / frame rate");
}

double focal_px_from_mm(double focal_mm, double sensor_width_mm, int width_px) {
  require_range("focal length (mm)", focal_mm, 0.1, 1e4);
  require_range("sensor width (mm)", sensor_width_mm, 0.1, 1e3);
  return focal_mm / sensor_width_mm * width_px;
}

double focal_px_from_fov(double fov_deg, int width_px) {
  require_range("field of view (degrees, across the width)", fov_deg, 0.1, 170.0);
  return 0.5 * width_px / std::tan(0.5 * fov_deg * std::numbers::pi / 180.0);
}

PlannedCamera turned(const PlannedCamera& camera) noexcept {
  PlannedCamera out = camera;
  std::swap(out.width_px, out.height_px);
  switch (camera.direction) {  // clockwise
    case ReadoutDirection::kDown:
      out.direction = ReadoutDirection::kLeft;
      break;
    case ReadoutDirection::kLeft:
      out.direction = ReadoutDirection::kUp;
      break;
    case ReadoutDirection::kUp:
      out.direction = ReadoutDirection::kRight;
      break;
    case ReadoutDirection::kRight:
      out.direction = ReadoutDirection::kDown;
      break;
  }
  return out;
}

bool reads_along(const PlannedCamera& camera, LongAxis axis) noexcept {
  return reads_rows(camera.direction) == (axis == LongAxis::kVertical);
}

std::vector<double> row_delays_s(const PlannedCamera& camera, LongAxis axis, double distance_mm, double length_mm,
                                 const std::vector<double>& positions) {
  const ReadoutModel readout{camera.readout_s, camera.direction, camera.width_px, camera.height_px};
  const double u0 = 0.5 * camera.width_px, v0 = 0.5 * camera.height_px;
  const double px_per_mm = camera.focal_px / distance_mm;
  std::vector<double> delays;
  for (const double x : positions) {
    const double from_middle_px = (x - 0.5) * length_mm * px_per_mm;
    delays.push_back(axis == LongAxis::kVertical ? readout.delay_s(u0, v0 - from_middle_px)
                                                 : readout.delay_s(u0 + from_middle_px, v0));
  }
  return delays;
}

}  // namespace core::planning
