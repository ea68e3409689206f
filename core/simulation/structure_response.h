#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/simulation/periodic_signal.h"
#include "core/simulation/scene.h"

namespace core::simulation {

// Shapes of the uniform fixed-free shear chain, floors x modes, each scaled to a largest component of +1.
[[nodiscard]] Eigen::MatrixXd shear_chain_shapes(int n_floors);

// Absolute horizontal displacement of base and floors under white base acceleration, exact for the linear structure: an
// independent complex Gaussian per bin inside the band, divided by -w^2 for the base's displacement and multiplied by
// each mode's transfer function for the floors. No integrator, no starting transient.
// The bins make the record periodic; its correlation is the true one plus copies shifted by multiples of the period.
// The period exceeds the duration by at least 12 time constants of the slowest mode, so within the clip the modal part
// of those copies stays below exp(-12), and lags up to the duration are never repeated.
class StructureResponse {
 public:
  // grid_rate_hz: of the interpolation grid; 200 keeps the interpolation error below 1e-5 of the roof's rms.
  StructureResponse(const StructureParameters& structure, std::uint64_t seed, double duration_s,
                    double grid_rate_hz = 200.0);

  [[nodiscard]] int n_bodies() const noexcept { return static_cast<int>(displacement_.size()); }
  // Body 0 is the base, body i floor i; true absolute displacement at any time.
  [[nodiscard]] double displacement_mm(int body, double t_s) const noexcept;
  [[nodiscard]] double rms_mm(int body) const noexcept;        // absolute, over the clip
  [[nodiscard]] double roof_relative_rms_mm() const noexcept;  // relative to the base, over the clip
  [[nodiscard]] double base_acceleration_rms_mm_s2() const noexcept { return base_acceleration_rms_; }

 private:
  double duration_s_;
  double base_acceleration_rms_ = 0.0;
  double roof_relative_rms_ = 0.0;
  std::vector<PeriodicSignal> displacement_;
};

}  // namespace core::simulation
