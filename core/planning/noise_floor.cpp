#include "core/planning/noise_floor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/planning/check_value.h"
#include "core/types/constants.h"

namespace core::planning {

double point_sigma_px(const PointQuality& quality) {
  require_range("noise of a pixel (grey levels rms)", quality.noise_grey, 0.0, 100.0);
  require_range("gradient of the texture (grey levels per px rms)", quality.gradient_grey, 0.01, 128.0);
  require_range("tracked patch (px)", quality.window_px, 3.0, 1000.0);
  require_range("excess of the tracker over the bound", quality.tracker_factor, 1.0, 100.0);
  constexpr double kRounding = 1.0 / 12.0;
  return quality.tracker_factor * std::sqrt(quality.noise_grey * quality.noise_grey + kRounding) /
         (quality.gradient_grey * quality.window_px);
}

double independent_points(int n_points, double width_px, double height_px, double window_px) noexcept {
  if (width_px <= 0.0 || height_px <= 0.0) return n_points;
  const double patches = (width_px + window_px) * (height_px + window_px) / (window_px * window_px);
  return std::min<double>(n_points, std::max(1.0, patches));
}

NoiseFloor noise_floor(double point_sigma_px, double independent_points, double mm_per_px, double rate_hz) noexcept {
  NoiseFloor floor;
  floor.point_sigma_px = point_sigma_px;
  floor.independent_points = independent_points;
  floor.channel_sigma_mm = mm_per_px * point_sigma_px / std::sqrt(independent_points);
  floor.density_mm_per_sqrt_hz = floor.channel_sigma_mm * std::sqrt(2.0 / rate_hz);
  return floor;
}

double exposure_gain(double frequency_hz, double exposure_s) noexcept {
  const double x = kPi * frequency_hz * exposure_s;
  return x < 1e-9 ? 1.0 : std::abs(std::sin(x) / x);
}

double peak_density(double rms_mm, double damping_ratio, double frequency_hz, double bandwidth_hz) noexcept {
  return rms_mm * rms_mm / (kPi * damping_ratio * frequency_hz + bandwidth_hz);
}

double least_rms_mm(double ratio, double density_mm_per_sqrt_hz, double damping_ratio, double frequency_hz,
                    double bandwidth_hz, double gain) noexcept {
  constexpr double kNothingLeft = 1e-6;  // gain of an exposure over whole periods
  if (gain < kNothingLeft) return std::numeric_limits<double>::infinity();
  const double width_hz = kPi * damping_ratio * frequency_hz + bandwidth_hz;
  return density_mm_per_sqrt_hz * std::sqrt(ratio * width_hz) / gain;
}

}  // namespace core::planning
