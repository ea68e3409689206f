#pragma once

#include <string>
#include <vector>

#include "core/simulation/scene.h"
#include "core/types/closure_result.h"

namespace tools {

// A parameter of an effect known to the simulator, under the name used by residual diagnosis.
struct KnownValue {
  std::string name;
  double value = 0.0;
};

// An effect that the operator does not declare. Parameters other than its size (signs, directions, frequencies) are
// drawn the scene's seed.
struct HiddenEffect {
  std::string name;    // of the case
  std::string called;  // name in core/closure
  double most = 0.0;   // largest sensible size
  double start = 0.0;  // a small size, from which others are scaled
  void (*set)(core::simulation::Scene&, double size) = nullptr;
  std::vector<KnownValue> (*truth)(const core::simulation::Scene& with,
                                   const core::simulation::Scene& declared) = nullptr;
};
[[nodiscard]] const std::vector<HiddenEffect>& hidden_effects();
[[nodiscard]] const HiddenEffect& effect_named(const std::string& name);  // throws std::invalid_argument

// Errors of the parameters stated by a step, in their stated sigmas.
struct ParameterErrors {
  double worst_sigmas = 0.0;  // infinite if a known one is not stated, or has no sigma; NaN: the effect is not named
  double first = 0.0;         // of the first known one, in its unit; NaN likewise
};
[[nodiscard]] ParameterErrors parameter_errors(const std::vector<core::closure::ClosureStep>& steps,
                                               const std::string& called, const std::vector<KnownValue>& truth);

}  // namespace tools
