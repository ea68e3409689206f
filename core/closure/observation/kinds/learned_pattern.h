#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/closure/observation/effect_in_model.h"

namespace core::closure {

struct LearnedName {
  EffectId id;
  std::string name;
  EffectKind kind = EffectKind::kNamed;
};

// A pattern learned from the residual, in the model.
class LearnedPattern : public EffectInModel {
 public:
  // pattern: px, 2 points long, of any size.
  LearnedPattern(LearnedName called, RungSet band, Eigen::VectorXd pattern);

  [[nodiscard]] std::unique_ptr<EffectInModel> clone() const override {
    return std::make_unique<LearnedPattern>(*this);
  }
  [[nodiscard]] EffectKind kind() const override { return kind_; }
  [[nodiscard]] std::vector<ParameterValue> parameters(const FitView& fit,
                                                       const Eigen::RowVectorXd& amplitude) const override;
  [[nodiscard]] const Eigen::VectorXd* pattern() const override { return &pattern_; }
  [[nodiscard]] RungSet band() const override { return band_; }

 protected:
  void set_pattern(Eigen::VectorXd pattern);  // of any size

 private:
  EffectKind kind_;
  RungSet band_;
  Eigen::VectorXd pattern_;  // 1 px rms over the points
};

}  // namespace core::closure
