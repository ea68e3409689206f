#include "core/closure/observation/kinds/family_effect.h"

#include <Eigen/QR>
#include <cmath>
#include <utility>

#include "core/closure/observation/kinds/follows_motion.h"
#include "core/closure/observation/kinds/learned_pattern.h"
#include "core/closure/observation/kinds/materiality.h"

namespace core::closure {
namespace {

constexpr int kRounds = 2;  // pattern, band, pattern, band

class FamilyCandidate final : public EffectCandidate {
 public:
  FamilyCandidate(const FamilyEffect& effect, const FitView& fit)
      : effect_(effect), fit_(fit), fields_(effect.fields(fit.record, fit.model.geometry())) {
    const Eigen::MatrixXd w = fit.model.whitened(fields_);
    const Eigen::MatrixXd& q = fit.model.q_high();
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(w - q * (q.transpose() * w));
    qr.setThreshold(kLeastBeside);
    span_ = Eigen::MatrixXd(qr.householderQ()).leftCols(w.cols() > 0 ? qr.rank() : 0);
  }
  [[nodiscard]] double gain(const TestedResidual& residual) const override { return learned(residual.moments).gain; }
  double find(const TestedResidual& residual) override {
    found_ = learned(residual.moments);
    if (span_.cols() > 0) pattern_ = in_px(leading(found_.band, residual.moments));
    return found_.gain;
  }
  [[nodiscard]] double material_share() const override { return material_of(found_.band, fit_, kLearnedBar); }
  [[nodiscard]] std::optional<double> free_gain(const TestedResidual& residual) const override {
    return fit_.held_out.of_learned_in(found_.band, residual.moments);
  }
  [[nodiscard]] Objection objection(const TestedResidual& /*residual*/) const override {
    if (pattern_.size() == 0) return {};
    return follows_motion(fit_, fit_.model.whitened(pattern_), found_.band);
  }
  [[nodiscard]] std::unique_ptr<EffectInModel> adopted() const override {
    return effect_.in_model(found_.band, pattern_);
  }

 private:
  [[nodiscard]] Eigen::VectorXd leading(RungSet band, const ResidualMoments& moments) const {
    const Eigen::MatrixXd within = span_.transpose() * fit_.held_out.sum_over(band, moments) * span_;
    return span_ * leading_pattern(within);
  }
  [[nodiscard]] PatternGain learned(const ResidualMoments& moments) const {
    if (span_.cols() == 0) return {};
    RungSet band = kAllRungs;
    for (int round = 0; round < kRounds; ++round)
      band = fit_.held_out.of_pattern(pattern_beside(fit_.model, leading(band, moments)), moments).band;
    return {fit_.held_out.of_learned_in(band, moments, span_), band};
  }
  // The combination of the fields that leaves this pattern beside the model.
  [[nodiscard]] Eigen::VectorXd in_px(const Eigen::VectorXd& beside) const {
    const Eigen::MatrixXd w = fit_.model.whitened(fields_);
    const Eigen::MatrixXd& q = fit_.model.q_high();
    const Eigen::MatrixXd left = w - q * (q.transpose() * w);
    return fields_ * left.colPivHouseholderQr().solve(beside);
  }

  const FamilyEffect& effect_;
  const FitView fit_;
  Eigen::MatrixXd fields_, span_;
  PatternGain found_;
  Eigen::VectorXd pattern_;
};

}  // namespace

std::unique_ptr<EffectInModel> FamilyEffect::in_model(RungSet band, const Eigen::VectorXd& pattern) const {
  return std::make_unique<LearnedPattern>(LearnedName{id(), name()}, band, pattern);
}

std::optional<NotObservable> FamilyEffect::obstacle(const FitView& fit, bool is_adopted) const {
  if (is_adopted || fields(fit.record, fit.model.geometry()).cols() > 0) return std::nullopt;
  return when_absent();
}

std::unique_ptr<EffectCandidate> FamilyEffect::candidate(const FitView& fit) const {
  return std::make_unique<FamilyCandidate>(*this, fit);
}

}  // namespace core::closure
