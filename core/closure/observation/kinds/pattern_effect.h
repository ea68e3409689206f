#pragma once

#include "core/closure/observation/effect.h"
#include "core/closure/observation/held_out.h"

namespace core::closure {

// A known pattern over the image with an amplitude in every frame, in some rungs of the spectrum or in all.
class PatternEffect : public ObservationEffect {
 public:
  // px per internal unit, 2 points long.
  [[nodiscard]] virtual Eigen::VectorXd pattern(const ObservationRecord& record,
                                                const PointGeometry& geometry) const = 0;
  [[nodiscard]] virtual std::string unit() const = 0;
  [[nodiscard]] virtual double per_unit() const { return 1.0; }  // reported value = internal value * per_unit
  // Why an amplitude with this gain in its band is not that of the effect; empty: no reason. residual: of the fit.
  [[nodiscard]] virtual std::string not_in(const PatternGain& /*found*/, const ResidualMoments& /*residual*/,
                                           const FitView& /*fit*/) const {
    return {};
  }
  // Of the camera per internal unit, where the pattern is the first order of a rotation.
  [[nodiscard]] virtual Eigen::Vector3d rotation() const { return Eigen::Vector3d::Zero(); }

  [[nodiscard]] std::size_t n_parameters() const final { return 1; }
  [[nodiscard]] std::optional<NotObservable> obstacle(const FitView& fit, bool is_adopted) const override;
  [[nodiscard]] std::unique_ptr<EffectCandidate> candidate(const FitView& fit) const final;
  [[nodiscard]] Eigen::MatrixXd shapes(const FitView& fit) const final {
    return pattern(fit.record, fit.model.geometry());
  }
};

// Standard deviation of an amplitude of a whitened pattern `w` beside the model's own columns, noise removed; and its
// sigma.
[[nodiscard]] ParameterValue amplitude_rms(const FitView& fit, const Eigen::VectorXd& w, RungSet band,
                                           const Eigen::RowVectorXd& amplitude);

}  // namespace core::closure
