#pragma once

#include <cstdint>

#include "core/identification/era.h"

namespace core {

enum class GramStatus : std::uint8_t { kOk, kRankDeficient, kIllConditioned };

// realise() through the eigenvectors of G^T G, G the (weighted) Hankel matrix: a tenth of the work of its singular
// value decomposition, because only the needed vectors are computed. Squaring loses singular values below 1e-8 of the
// largest; kIllConditioned if a needed one is near that limit (data without noise).
[[nodiscard]] GramStatus realise_by_gram(const Correlations& correlations, const EraConfig& config, Realisation& out);

}  // namespace core
