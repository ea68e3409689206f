#pragma once

#include <array>
#include <cstdint>

#include "core/simulation/periodic_signal.h"
#include "core/simulation/projection.h"
#include "core/simulation/scene.h"

namespace core::simulation {

// The camera's drift while hovering: six independent Gaussian processes with the density of HoverParameters, one random
// stream each. The mean over all time is zero; at t = 0 the camera is somewhere within its drift.
class HoverMotion {
 public:
  HoverMotion(const HoverParameters& hover, std::uint64_t seed, double duration_s);

  [[nodiscard]] CameraPose at(double t_s) const noexcept;
  [[nodiscard]] bool rotates() const noexcept { return rotates_; }
  // x, y, z in mm, pitch, yaw, roll in rad; over the clip, about zero.
  [[nodiscard]] std::array<double, 6> rms() const noexcept;

 private:
  double duration_s_;
  bool rotates_;
  std::array<PeriodicSignal, 6> signal_;
};

}  // namespace core::simulation
