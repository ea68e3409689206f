#pragma once

#include <memory>

#include "core/closure/observation/effect.h"

namespace core::closure {

// A pattern over the image within the span of some fields, with an amplitude in every frame: which combination of the
// fields moves is learned from the residual.
class FamilyEffect : public ObservationEffect {
 public:
  // px per unit, 2 points x fields; without columns where the record has none.
  [[nodiscard]] virtual Eigen::MatrixXd fields(const ObservationRecord& record,
                                               const PointGeometry& geometry) const = 0;
  [[nodiscard]] virtual NotObservable when_absent() const = 0;
  // pattern: the combination found, px, 2 points long.
  [[nodiscard]] virtual std::unique_ptr<EffectInModel> in_model(RungSet band, const Eigen::VectorXd& pattern) const;

  [[nodiscard]] std::size_t n_parameters() const override { return 2; }
  [[nodiscard]] std::optional<NotObservable> obstacle(const FitView& fit, bool is_adopted) const final;
  [[nodiscard]] std::unique_ptr<EffectCandidate> candidate(const FitView& fit) const final;
  [[nodiscard]] Eigen::MatrixXd shapes(const FitView& fit) const final {
    return fields(fit.record, fit.model.geometry());
  }
};

}  // namespace core::closure
