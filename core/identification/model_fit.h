#pragma once

#include <string>
#include <vector>

#include "core/identification/correlation.h"
#include "core/identification/era.h"
#include "core/identification/identifier.h"
#include "core/types/cpsd.h"
#include "core/types/displacement.h"

namespace core {

// The realisation of a record, and how it was made.
struct ModelFit {
  int n_differences = 0;
  EraConfig era;
  Correlations correlations;
  Realisation realisation;
  int order = 0;  // the lowest of the stabilisation diagram
  // Do the canonical correlations drop there? If not, the input is coloured or not stationary.
  bool order_is_clear = false;
  int last_first_i_order = 1;  // VerdictRules; -1 = no canonical correlation reaches one half: nothing is a mode
};

// Chooses references, block rows and order where the configuration does not fix them. "ok", or why there is no model.
[[nodiscard]] std::string fit_model(const CpsdSums& sums, const IdentifierConfig& config,
                                    const std::vector<ChannelInfo>& channels, ModelFit& out);

}  // namespace core
