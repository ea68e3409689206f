#pragma once

#include <vector>

#include "core/types/frame.h"

namespace core::planning {

struct PlannedCamera {
  int width_px = 1920, height_px = 1080;  // as delivered
  double focal_px = 2100.0;
  double rate_hz = 25.0;
  double readout_s = 0.026;  // signed; 0 = global shutter
  ReadoutDirection direction = ReadoutDirection::kDown;
  double exposure_s = 0.004;  // 0 = so short that it does not matter
};

// The long direction of the structure in the picture: a tower stands, a bridge lies.
enum class LongAxis { kVertical, kHorizontal };

// Throws std::invalid_argument naming the value and the range.
void validate(const PlannedCamera& camera);

// Focal length in px from what a data sheet states. `fov_deg`: across the width of the picture.
[[nodiscard]] double focal_px_from_mm(double focal_mm, double sensor_width_mm, int width_px);
[[nodiscard]] double focal_px_from_fov(double fov_deg, int width_px);

// The camera turned by 90 degrees: picture and readout direction turn with it.
[[nodiscard]] PlannedCamera turned(const PlannedCamera& camera) noexcept;

// S = Z / alpha for a camera that looks square at the structure.
[[nodiscard]] inline double mm_per_px(const PlannedCamera& camera, double distance_mm) noexcept {
  return distance_mm / camera.focal_px;
}

// Room for the structure's long direction, px.
[[nodiscard]] inline double room_px(const PlannedCamera& camera, LongAxis axis) noexcept {
  return axis == LongAxis::kVertical ? camera.height_px : camera.width_px;
}

[[nodiscard]] bool reads_along(const PlannedCamera& camera, LongAxis axis) noexcept;

// Row delay of places along the structure (mm from its foot or left end), whose middle is in the middle of the picture;
// the same for all where the readout runs across the structure. tau = T_r v / h (core/geometry,
// ReadoutModel). A standing structure's foot is below.
[[nodiscard]] std::vector<double> row_delays_s(const PlannedCamera& camera, LongAxis axis, double distance_mm,
                                               double length_mm, const std::vector<double>& positions);

}  // namespace core::planning
