#pragma once

#include <cstdint>
#include <vector>

#include "core/simulation/injected/parameters.h"

namespace core::simulation {

// ShimmerParameters over image and time: a sum of plane waves, their wave vectors drawn from the screen's spectrum, k^2
// (k^2 + k0^2)^(-11/6) exp(-(k / km)^2) of the shift per unit of wave vector, k0 = 2 pi / outer, km = 5.92 / inner
// (Tatarskii 1971). Each wave moves with the drift plus a velocity of its own.
class Shimmer {
 public:
  Shimmer() = default;  // none
  Shimmer(const ShimmerParameters& parameters, std::uint64_t seed);

  struct Shift {
    double u_px = 0.0, v_px = 0.0;
  };
  [[nodiscard]] Shift at(double u_px, double v_px, double t_s) const noexcept;

 private:
  struct Wave {
    double ku, kv, w, phase;  // rad/px, rad/s, rad
    double shift_u, shift_v;  // px, along the wave vector
  };
  std::vector<Wave> waves_;
};

}  // namespace core::simulation
