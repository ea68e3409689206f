#pragma once

#include <memory>
#include <string>

#include "core/closure/observation/effect_in_model.h"

namespace core::closure {

struct LearnedName {
  EffectId id;
  std::string name;
  EffectKind kind = EffectKind::kNamed;
};

// A pattern learned from the residual, in the model: px, 2 points long, of any size.
[[nodiscard]] std::unique_ptr<EffectInModel> learned_pattern(LearnedName called, RungSet band, Eigen::VectorXd pattern);

}  // namespace core::closure
