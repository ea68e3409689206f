#pragma once

#include <string>
#include <vector>

#include "tools/validate/closure_effects.h"

namespace tools {

// An effect of real records, made by core/simulation/injected or by the camera's full formulas, and the names by which
// closing the loop may call it. Where the catalogue has none of them, a latent effect is the right answer.
struct ForeignEffect {
  HiddenEffect effect;             // `called`: the first of the names
  std::vector<std::string> names;  // any of them, and nothing else, is right
  bool in_background = false;      // it shows nowhere else: records with it hold the background
};
// Those of hidden_effects(), then those that only foreign records have.
[[nodiscard]] const std::vector<ForeignEffect>& foreign_effects();

// What closing the loop made of a record with known effects.
enum class Answer : std::uint8_t {
  kNamed,     // every effect by one of its names, nothing else
  kLatent,    // latent effects, alone or beside right names
  kMisnamed,  // a name that is not there
  kPart,      // some of the effects by their names, the others not at all
  kNothing
};
// Errors of the stated parameters whose truth is known, in their stated sigmas, signed.
[[nodiscard]] std::vector<double> errors_in_sigmas(const std::vector<core::closure::ClosureStep>& steps,
                                                   const ForeignEffect& effect, const std::vector<KnownValue>& truth);
[[nodiscard]] const ForeignEffect& foreign_effect_named(const std::string& name);  // throws std::invalid_argument
// Whether both in one record could be told apart by their names.
[[nodiscard]] bool share_a_name(const ForeignEffect& a, const ForeignEffect& b);

[[nodiscard]] const char* word_for(Answer answer) noexcept;
[[nodiscard]] Answer answer_of(const std::vector<core::closure::ClosureStep>& steps,
                               const std::vector<const ForeignEffect*>& effects);

}  // namespace tools
