#include "core/closure/observation/kinds/latent_pattern.h"

#include "core/closure/observation/kinds/learned_pattern.h"
#include "core/closure/observation/kinds/materiality.h"

namespace core::closure {
namespace {

class LatentCandidate final : public EffectCandidate {
 public:
  LatentCandidate(std::size_t number, const FitView& fit) : number_(number), fit_(fit) {}
  [[nodiscard]] double gain(const TestedResidual& residual) const override {
    return fit_.held_out.of_learned(residual.moments).gain;
  }
  double find(const TestedResidual& residual) override {
    found_ = fit_.held_out.of_learned(residual.moments);
    pattern_ = fit_.model.in_px(leading_pattern(fit_.held_out.sum_over(found_.band, residual.moments)));
    return found_.gain;
  }
  // In whichever rungs: what has no name must change the whole residual. Folded modes leave narrow patterns of 0.005.
  [[nodiscard]] double material_share() const override { return kLearnedBar; }
  [[nodiscard]] bool is_learned() const override { return true; }
  [[nodiscard]] std::unique_ptr<EffectInModel> adopted() const override {
    return std::make_unique<LearnedPattern>(LearnedName{latent_id(number_), latent_name(number_), EffectKind::kLatent},
                                            found_.band, pattern_);
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
