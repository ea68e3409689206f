#include "core/closure/observation/kinds/learned_pattern.h"

#include <cmath>
#include <utility>

#include "core/closure/observation/kinds/pattern_effect.h"
#include "core/closure/observation/strongest_hz.h"

namespace core::closure {

LearnedPattern::LearnedPattern(LearnedName called, RungSet band, Eigen::VectorXd pattern)
    : EffectInModel(std::move(called.id), std::move(called.name)), kind_(called.kind), band_(band) {
  set_pattern(std::move(pattern));
}

void LearnedPattern::set_pattern(Eigen::VectorXd pattern) {
  pattern_ = std::move(pattern);
  pattern_ *= std::sqrt(static_cast<double>(pattern_.size())) / pattern_.norm();
}

std::vector<ParameterValue> LearnedPattern::parameters(const FitView& fit, const Eigen::RowVectorXd& amplitude) const {
  const ParameterValue size = amplitude_rms(fit, fit.model.whitened(pattern_), band_, amplitude);
  if (kind_ == EffectKind::kLatent) return {size};
  return {size, {"frequency", "Hz", strongest_hz(amplitude, fit.record.rate_hz), std::nullopt}};
}

}  // namespace core::closure
