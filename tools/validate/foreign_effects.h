#pragma once

#include <string>
#include <vector>

#include "tools/validate/closure_effects.h"

namespace tools {

// An effect of real records, simulated by core/simulation/injected or by the camera's full formulas, and the names by
// which residual diagnosis may call it. If the catalogue has none of them, a latent effect is the correct result.
struct ForeignEffect {
  HiddenEffect effect;             // `called`: the first of the names
  std::vector<std::string> names;  // correct result: any of these and nothing else
  bool in_background = false;      // visible only there: records with it contain the background
};
// Those of hidden_effects(), then those that occur in foreign records only.
[[nodiscard]] const std::vector<ForeignEffect>& foreign_effects();

// Result of residual diagnosis for a record with known effects.
enum class Answer : std::uint8_t {
  kNamed,     // every effect by one of its names, nothing else
  kLatent,    // latent effects, alone or with correct names
  kMisnamed,  // an effect that is not in the record
  kPart,      // some of the effects by their names, the others not at all
  kNothing
};
// Errors of the stated parameters whose truth is known, in their stated sigmas, signed.
[[nodiscard]] std::vector<double> errors_in_sigmas(const std::vector<core::closure::ClosureStep>& steps,
                                                   const ForeignEffect& effect, const std::vector<KnownValue>& truth);
[[nodiscard]] const ForeignEffect& foreign_effect_named(const std::string& name);  // throws std::invalid_argument
// Whether the two effects could be confused by name in one record.
[[nodiscard]] bool share_a_name(const ForeignEffect& a, const ForeignEffect& b);

[[nodiscard]] const char* word_for(Answer answer) noexcept;
[[nodiscard]] Answer answer_of(const std::vector<core::closure::ClosureStep>& steps,
                               const std::vector<const ForeignEffect*>& effects);

}  // namespace tools
