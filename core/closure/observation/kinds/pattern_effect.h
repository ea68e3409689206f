#pragma once

#include "core/closure/observation/effect.h"

namespace core::closure {

// A known pattern over the image with an amplitude in every frame, in the low band or at all frequencies.
class PatternEffect : public ObservationEffect {
 public:
  // px per internal unit, 2 points long.
  [[nodiscard]] virtual Eigen::VectorXd pattern(const PointGeometry& geometry) const = 0;
  [[nodiscard]] virtual std::string unit() const = 0;
  [[nodiscard]] virtual double per_unit() const { return 1.0; }  // reported value = internal value * per_unit
  // Rotation of the camera per internal unit, if the pattern is the first order of a rotation.
  [[nodiscard]] virtual Eigen::Vector3d rotation() const { return Eigen::Vector3d::Zero(); }

  [[nodiscard]] std::size_t n_parameters() const final { return 1; }
  [[nodiscard]] std::optional<NotObservable> obstacle(const FitView& fit, bool is_adopted) const final;
  [[nodiscard]] std::unique_ptr<EffectCandidate> candidate(const FitView& fit) const final;
};

// Standard deviation over time of the amplitude of a whitened pattern `w`, corrected for noise, and its sigma. The
// noise is that of an amplitude fitted together with the model's own columns.
[[nodiscard]] ParameterValue amplitude_rms(const FitView& fit, const Eigen::VectorXd& w, bool low_band,
                                           const Eigen::RowVectorXd& amplitude);

}  // namespace core::closure
