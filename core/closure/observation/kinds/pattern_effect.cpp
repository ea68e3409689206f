#include "core/closure/observation/kinds/pattern_effect.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/closure/observation/kinds/follows_motion.h"
#include "core/closure/observation/kinds/materiality.h"

namespace core::closure {
namespace {

double rms(const Eigen::RowVectorXd& a) {
  return a.size() > 0 ? std::sqrt((a.array() - a.mean()).square().mean()) : 0.0;
}

class PatternInModel final : public EffectInModel {
 public:
  PatternInModel(const PatternEffect& effect, RungSet band, const FitView& fit)
      : EffectInModel(effect.id(), effect.name()),
        effect_(effect),
        band_(band),
        pattern_(effect.pattern(fit.record, fit.model.geometry())) {}
  [[nodiscard]] std::unique_ptr<EffectInModel> clone() const override {
    return std::make_unique<PatternInModel>(*this);
  }
  [[nodiscard]] std::vector<ParameterValue> parameters(const FitView& fit,
                                                       const Eigen::RowVectorXd& amplitude) const override {
    ParameterValue size = amplitude_rms(fit, fit.model.whitened(pattern_), band_, amplitude);
    size.unit = effect_.unit();
    size.value *= effect_.per_unit();
    *size.sigma *= effect_.per_unit();
    return {size, {"band", "Hz", fit.held_out.rungs().highest_hz(band_), std::nullopt}};
  }
  [[nodiscard]] const Eigen::VectorXd* pattern() const override { return &pattern_; }
  [[nodiscard]] RungSet band() const override { return band_; }
  void set_places(const ObservationRecord& record, const PointGeometry& geometry) override {
    pattern_ = effect_.pattern(record, geometry);
  }
  [[nodiscard]] Eigen::Vector3d rotation() const override { return effect_.rotation(); }

 private:
  const PatternEffect& effect_;
  RungSet band_;
  Eigen::VectorXd pattern_;
};

class PatternCandidate final : public EffectCandidate {
 public:
  PatternCandidate(const PatternEffect& effect, const FitView& fit)
      : effect_(effect), fit_(fit), beside_(pattern_beside(fit.model, whitened())) {}
  [[nodiscard]] double gain(const TestedResidual& residual) const override { return tried(residual).gain; }
  double find(const TestedResidual& residual) override {
    found_ = tried(residual);
    return found_.gain;
  }
  [[nodiscard]] double material_share() const override { return material_of(found_.band, fit_, kFullBandBar); }
  [[nodiscard]] std::optional<double> free_gain(const TestedResidual& residual) const override {
    return fit_.held_out.of_learned_in(found_.band, residual.moments);
  }
  [[nodiscard]] Objection objection(const TestedResidual& residual) const override {
    if (std::string words = effect_.not_in(found_, residual.moments, fit_); !words.empty())
      return {std::move(words), true};
    return follows_motion(fit_, whitened(), found_.band);
  }
  [[nodiscard]] std::unique_ptr<EffectInModel> adopted() const override {
    return std::make_unique<PatternInModel>(effect_, found_.band, fit_);
  }

 private:
  [[nodiscard]] PatternGain tried(const TestedResidual& residual) const {
    return fit_.held_out.of_pattern(beside_, residual.moments);
  }
  [[nodiscard]] Eigen::VectorXd whitened() const {
    return fit_.model.whitened(effect_.pattern(fit_.record, fit_.model.geometry()));
  }

  const PatternEffect& effect_;
  const FitView fit_;
  PatternBeside beside_;
  PatternGain found_;
};

}  // namespace

ParameterValue amplitude_rms(const FitView& fit, const Eigen::VectorXd& w, RungSet band,
                             const Eigen::RowVectorXd& amplitude) {
  const Eigen::MatrixXd& q = band != kAllRungs ? fit.model.q_low() : fit.model.q_high();
  const auto own = q.leftCols(fit.model.own_rank());
  const Eigen::VectorXd others = w - own * (own.transpose() * w);
  const double share = band != kAllRungs ? fit.held_out.share_of(fit.model.band()) : 1.0;
  const double noise = others.norm() > 0.0 ? std::sqrt(share) / others.norm() : 0.0;  // per frame
  const double value = std::sqrt(std::max(std::pow(rms(amplitude), 2) - noise * noise, 0.0));
  const double sigma = noise / std::sqrt(share * static_cast<double>(fit.record.n_frames()));
  return {"rms", "px", value, sigma};
}

std::optional<NotObservable> PatternEffect::obstacle(const FitView& fit, bool is_adopted) const {
  if (is_adopted) return std::nullopt;
  const Eigen::VectorXd w = fit.model.whitened(pattern(fit.record, fit.model.geometry()));
  const double left = (w - fit.model.q_high() * (fit.model.q_high().transpose() * w)).norm();
  if (left > kLeastBeside * w.norm()) return std::nullopt;
  return NotObservable{name(), "the free motions of the regions span its pattern",
                       "declare larger regions or a background"};
}

std::unique_ptr<EffectCandidate> PatternEffect::candidate(const FitView& fit) const {
  return std::make_unique<PatternCandidate>(*this, fit);
}

}  // namespace core::closure
