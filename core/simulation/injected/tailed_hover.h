#pragma once

#include <array>
#include <cstdint>

#include "core/simulation/structure/periodic_signal.h"

namespace core::simulation {

// Hover whose spectrum falls off as a power law instead of ending: per axis a Gaussian process of its own, with a
// one-sided density ~ 1 / (1 + (f / corner)^order) up to 100 Hz, which no camera resolves. Axes: X, Y, Z (mm), pitch,
// yaw, roll (rad). Beside HoverParameters, which it may replace.
struct TailedHoverParameters {
  std::array<double, 3> rms_mm{}, corner_hz{0.2, 0.2, 0.2}, order{4.0, 4.0, 4.0};
  std::array<double, 3> rms_rad{}, turn_corner_hz{0.2, 0.2, 0.2}, turn_order{4.0, 4.0, 4.0};
};

class TailedHover {
 public:
  static constexpr double kLimit_hz = 100.0;

  TailedHover() = default;
  TailedHover(const TailedHoverParameters& parameters, std::uint64_t seed, double duration_s);

  [[nodiscard]] double at(std::size_t axis, double t_s) const noexcept { return axis_[axis].at(t_s); }  // 0 .. 5

 private:
  std::array<PeriodicSignal, 6> axis_;
};

}  // namespace core::simulation
