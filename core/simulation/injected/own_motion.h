#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/simulation/injected/parameters.h"
#include "core/simulation/structure/periodic_signal.h"

namespace core::simulation {

struct Scene;

// Motion of bodies, and of parts of them, that is not a mode of the structure.
class OwnMotion {
 public:
  explicit OwnMotion(const Scene& scene);

  [[nodiscard]] double flap_mm(double t_s) const noexcept { return flap_.at(t_s); }
  [[nodiscard]] double rocking_rad(double t_s) const noexcept { return rocking_.at(t_s); }
  [[nodiscard]] double torsion_rad(double t_s) const noexcept { return torsion_.at(t_s); }  // of the last body
  [[nodiscard]] double sway_mm(double t_s) const noexcept { return sway_.at(t_s); }
  [[nodiscard]] bool rocks() const noexcept { return rocks_; }

 private:
  PeriodicSignal flap_, rocking_, torsion_, sway_;
  bool rocks_;
};

}  // namespace core::simulation
