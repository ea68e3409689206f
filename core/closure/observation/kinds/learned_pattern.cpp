#include "core/closure/observation/kinds/learned_pattern.h"

#include <cmath>
#include <utility>

#include "core/closure/observation/kinds/pattern_effect.h"
#include "core/closure/observation/strongest_hz.h"

namespace core::closure {
namespace {

class LearnedInModel final : public EffectInModel {
 public:
  LearnedInModel(LearnedName called, RungSet band, Eigen::VectorXd pattern)
      : EffectInModel(std::move(called.id), std::move(called.name)),
        kind_(called.kind),
        band_(band),
        pattern_(std::move(pattern)) {
    pattern_ *= std::sqrt(static_cast<double>(pattern_.size())) / pattern_.norm();
  }
  [[nodiscard]] std::unique_ptr<EffectInModel> clone() const override {
    return std::make_unique<LearnedInModel>(*this);
  }
  [[nodiscard]] EffectKind kind() const override { return kind_; }
  [[nodiscard]] std::vector<ParameterValue> parameters(const FitView& fit,
                                                       const Eigen::RowVectorXd& amplitude) const override {
    const ParameterValue size = amplitude_rms(fit, fit.model.whitened(pattern_), band_, amplitude);
    if (kind_ == EffectKind::kLatent) return {size};
    return {size, {"frequency", "Hz", strongest_hz(amplitude, fit.record.rate_hz), std::nullopt}};
  }
  [[nodiscard]] const Eigen::VectorXd* pattern() const override { return &pattern_; }
  [[nodiscard]] RungSet band() const override { return band_; }

 private:
  EffectKind kind_;
  RungSet band_;
  Eigen::VectorXd pattern_;  // 1 px rms over the points
};

}  // namespace

std::unique_ptr<EffectInModel> learned_pattern(LearnedName called, RungSet band, Eigen::VectorXd pattern) {
  return std::make_unique<LearnedInModel>(std::move(called), band, std::move(pattern));
}

}  // namespace core::closure
