#pragma once

#include <string>
#include <vector>

#include "core/simulation/scene.h"
#include "core/types/closure_result.h"

namespace tools {

// A number of an effect that the simulator knows, under the name that closing the loop gives it.
struct KnownValue {
  std::string name;
  double value = 0.0;
};

// An effect that the operator does not declare. Numbers beside its size (signs, directions, frequencies) are drawn from
// the scene's seed.
struct HiddenEffect {
  std::string name;    // of the case
  std::string called;  // as core/closure calls it
  double most = 0.0;   // largest size that makes sense
  double start = 0.0;  // a small size, from which others are scaled
  void (*set)(core::simulation::Scene&, double size) = nullptr;
  std::vector<KnownValue> (*truth)(const core::simulation::Scene& with,
                                   const core::simulation::Scene& declared) = nullptr;
};
[[nodiscard]] const std::vector<HiddenEffect>& hidden_effects();
[[nodiscard]] const HiddenEffect& effect_named(const std::string& name);  // throws std::invalid_argument

// How far the parameters that a step states lie from the truth, in their stated sigmas.
struct ParameterErrors {
  double worst_sigmas = 0.0;  // infinite where a known one is not stated, or has no sigma; NaN: the effect is not named
  double first = 0.0;         // of the first known one, in its unit; NaN likewise
};
[[nodiscard]] ParameterErrors parameter_errors(const std::vector<core::closure::ClosureStep>& steps,
                                               const std::string& called, const std::vector<KnownValue>& truth);

}  // namespace tools
