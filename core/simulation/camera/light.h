#pragma once

#include "core/simulation/scene.h"
#include "core/simulation/structure/periodic_signal.h"

namespace core::simulation {

// Brightness of the scene over time: slow changes of exposure or clouds times the flicker of lamps.
class Light {
 public:
  explicit Light(const Scene& scene);

  // Mean over an exposure about t_s, relative to 1. Slow changes are evaluated at its centre; the flicker's mean is
  // exact.
  [[nodiscard]] double factor(double t_s) const noexcept;
  [[nodiscard]] bool constant() const noexcept { return constant_; }

 private:
  bool constant_;
  PeriodicSignal gain_;
  PeriodicSignal wander_rad_;
  double flicker_depth_, flicker_hz_, flicker_phase_rad_;
};

}  // namespace core::simulation
