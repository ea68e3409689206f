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
  double exposure_s = 0.004;  // 0 = negligibly short
};

// Long direction of the structure in the image: vertical for a tower, horizontal for a bridge.
enum class LongAxis { kVertical, kHorizontal };

// Throws std::invalid_argument with the value and the allowed range.
void validate(const PlannedCamera& camera);

// Focal length in px from data-sheet values. `fov_deg`: over the width of the image.
[[nodiscard]] double focal_px_from_mm(double focal_mm, double sensor_width_mm, int width_px);
[[nodiscard]] double focal_px_from_fov(double fov_deg, int width_px);

// The camera rotated by 90 degrees, including image size and readout direction.
[[nodiscard]] PlannedCamera turned(const PlannedCamera& camera) noexcept;

// S = Z / alpha for a camera in frontal view of the structure.
[[nodiscard]] inline double mm_per_px(const PlannedCamera& camera, double distance_mm) noexcept {
  return distance_mm / camera.focal_px;
}

// Image extent available along the structure's long direction, px.
[[nodiscard]] inline double room_px(const PlannedCamera& camera, LongAxis axis) noexcept {
  return axis == LongAxis::kVertical ? camera.height_px : camera.width_px;
}

[[nodiscard]] bool reads_along(const PlannedCamera& camera, LongAxis axis) noexcept;

// Row delay of places along the structure (mm from its foot or left end), whose centre is in the image centre; equal
// for all places if the readout runs across the structure. tau = T_r v / h (core/geometry, ReadoutModel). The foot of a
// vertical structure is at the bottom.
[[nodiscard]] std::vector<double> row_delays_s(const PlannedCamera& camera, LongAxis axis, double distance_mm,
                                               double length_mm, const std::vector<double>& positions);

}  // namespace core::planning
