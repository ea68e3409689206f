#include "core/closure/observation/kinds/latent_pattern.h"

#include <cmath>
#include <utility>

#include "core/closure/observation/kinds/materiality.h"
#include "core/closure/observation/kinds/pattern_effect.h"

namespace core::closure {
namespace {

class LatentInModel final : public EffectInModel {
 public:
  LatentInModel(std::size_t number, bool low_band, Eigen::VectorXd pattern)
      : EffectInModel(latent_id(number), latent_name(number)), low_band_(low_band), pattern_(std::move(pattern)) {}
  [[nodiscard]] std::unique_ptr<EffectInModel> clone() const override { return std::make_unique<LatentInModel>(*this); }
  [[nodiscard]] EffectKind kind() const override { return EffectKind::kLatent; }
  [[nodiscard]] std::vector<ParameterValue> parameters(const FitView& fit,
                                                       const Eigen::RowVectorXd& amplitude) const override {
    return {amplitude_rms(fit, pattern_.cwiseProduct(fit.model.weight()), low_band_, amplitude)};
  }
  [[nodiscard]] const Eigen::VectorXd* pattern() const override { return &pattern_; }
  [[nodiscard]] bool is_low_band() const override { return low_band_; }

 private:
  bool low_band_;
  Eigen::VectorXd pattern_;  // 1 px rms over the points
};

class LatentCandidate final : public EffectCandidate {
 public:
  LatentCandidate(std::size_t number, const FitView& fit) : number_(number), fit_(fit) {}
  [[nodiscard]] double gain(const TestedResidual& residual) const override {
    return fit_.held_out.of_learned(residual.moments).gain;
  }
  double find(const TestedResidual& residual) override {
    found_ = fit_.held_out.of_learned(residual.moments);
    pattern_ = leading_pattern(found_.low_band ? residual.moments.low_sum : residual.moments.all_sum)
                   .cwiseQuotient(fit_.model.weight());
    pattern_ *= std::sqrt(static_cast<double>(pattern_.size())) / pattern_.norm();
    return found_.gain;
  }
  [[nodiscard]] double material_share() const override { return kFullBandBar; }
  [[nodiscard]] std::unique_ptr<EffectInModel> adopted() const override {
    return std::make_unique<LatentInModel>(number_, found_.low_band, pattern_);
  }

 private:
  std::size_t number_;
  const FitView fit_;
  PatternGain found_;
  Eigen::VectorXd pattern_;
};

}  // namespace

EffectId latent_id(std::size_t number) { return {"latent_" + std::to_string(number)}; }
std::string latent_name(std::size_t number) { return "latent " + std::to_string(number); }

std::unique_ptr<EffectCandidate> latent_candidate(std::size_t number, const FitView& fit) {
  return std::make_unique<LatentCandidate>(number, fit);
}

}  // namespace core::closure
