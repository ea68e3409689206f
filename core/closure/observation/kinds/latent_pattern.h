#pragma once

#include <cstddef>
#include <memory>

#include "core/closure/observation/effect_candidate.h"

namespace core::closure {

// A pattern learned from the residual, without a name: the candidate beside those of the catalogue. number: from 1.
[[nodiscard]] std::unique_ptr<EffectCandidate> latent_candidate(std::size_t number, const FitView& fit);
[[nodiscard]] EffectId latent_id(std::size_t number);
[[nodiscard]] std::string latent_name(std::size_t number);

}  // namespace core::closure
