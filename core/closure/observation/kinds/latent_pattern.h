#pragma once

#include <cstddef>
#include <memory>

#include "core/closure/observation/effect_candidate.h"

namespace core::closure {

// Unnamed pattern learned from the residual: the candidate in addition to the catalogue. number: counts from 1.
[[nodiscard]] std::unique_ptr<EffectCandidate> latent_candidate(std::size_t number, const FitView& fit);
[[nodiscard]] EffectId latent_id(std::size_t number);
[[nodiscard]] std::string latent_name(std::size_t number);

}  // namespace core::closure
