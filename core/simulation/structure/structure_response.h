#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include "core/simulation/camera/uniform_spline.h"
#include "core/simulation/scene.h"
#include "core/simulation/structure/periodic_signal.h"

namespace core::simulation {

// Motion of ground and bodies under white base acceleration and white forces, exact for the linear structure:
// an independent complex Gaussian per bin inside the band, times the frequency response of the equations of
// motion (the ground's displacement: divided by -w^2). There is no integrator and no starting transient.
// Harmonic forces are added as their exact steady state. Ground, forces and each harmonic have separate streams
// and levels: switching one off leaves the others' motion unchanged. The level is that of this clip, not its
// expectation: over 60 s the rms of a slow mode scatters by 20 % and more, and results for a stated amplitude
// would not refer to it. The bins make the record periodic; its correlation is the true one plus copies shifted
// by multiples of the period. The period exceeds the duration by at least 12 time constants of the slowest
// mode, so within the clip the modal part of those copies stays below exp(-12), and lags up to the duration are
// never repeated. If the stiffness changes (changing_stiffness.h), the motion is integrated under the same
// input.
class StructureResponse {
 public:
  // grid_rate_hz: of the interpolation grid; 200 keeps the interpolation error below 1e-5 of the roof's rms.
  explicit StructureResponse(const Scene& scene, double grid_rate_hz = 200.0);
  StructureResponse(const StructureModel& model, const ExcitationParameters& excitation, std::uint64_t seed,
                    double duration_s, double grid_rate_hz = 200.0, const ChangeParameters& change = {});

  [[nodiscard]] int n_bodies() const noexcept { return static_cast<int>(displacement_.size()); }  // with the ground
  // Body 0 is the ground. True absolute displacement along the structure's axis, and tilt (rad), at any time.
  [[nodiscard]] double displacement_mm(int body, double t_s) const noexcept;
  [[nodiscard]] double tilt_rad(int body, double t_s) const noexcept;
  [[nodiscard]] bool tilts() const noexcept { return tilts_; }
  [[nodiscard]] double rms_mm(int body) const noexcept;        // absolute, over the clip, without harmonics
  [[nodiscard]] double roof_relative_rms_mm() const noexcept;  // of the last body to the ground, without harmonics
  [[nodiscard]] double base_acceleration_rms_mm_s2() const noexcept { return base_acceleration_rms_; }

 private:
  struct Line {  // one harmonic: complex amplitudes by body
    double w;
    std::vector<std::complex<double>> displacement, tilt;
  };
  void add_broadband(const StructureModel& model, const ExcitationParameters& excitation, std::uint64_t seed,
                     double grid_rate_hz, const ChangeParameters& change);
  void add_line(const StructureModel& model, const ExcitationParameters::Harmonic& harmonic, double phase_rad);

  double duration_s_;
  bool tilts_;
  double base_acceleration_rms_ = 0.0, roof_relative_rms_ = 0.0;
  std::vector<PeriodicSignal> displacement_, tilt_;
  std::vector<UniformSpline> changed_, changed_tilt_;  // per body relative to the ground, replaces these; or empty
  std::vector<Line> lines_;
};

}  // namespace core::simulation
