#pragma once

#include <array>
#include <cstdint>

#include "core/simulation/injected/parameters.h"
#include "core/simulation/structure/periodic_signal.h"

namespace core::simulation {

// TailedHoverParameters over time. Axes: X, Y, Z (mm), pitch, yaw, roll (rad).
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
