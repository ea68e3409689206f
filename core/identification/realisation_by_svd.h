#pragma once

#include "core/identification/era.h"

namespace core {

// realise() through the singular value decomposition of the Hankel matrix, for matrices of any condition.
[[nodiscard]] EraStatus realise_by_svd(const Correlations& correlations, const EraConfig& config, Realisation& out);

}  // namespace core
