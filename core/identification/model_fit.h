#pragma once

#include <string>
#include <vector>

#include "core/identification/correlation.h"
#include "core/identification/era.h"
#include "core/identification/identifier.h"
#include "core/types/cpsd.h"
#include "core/types/displacement.h"

namespace core {

// The realisation of a record and the choices that led to it.
struct ModelFit {
  int n_differences = 0;
  EraConfig era;
  Correlations correlations;
  Realisation realisation;
  int order = 0;  // lowest order of the stabilisation diagram
  // True if the canonical correlations drop at that order. If not, the input is coloured or not stationary.
  bool order_is_clear = false;
  int last_first_i_order = 1;  // see VerdictRules; -1: no canonical correlation reaches one half, no pole is a mode
};

// Chooses references, block rows and order unless the configuration fixes them. "ok", or the reason for no model.
[[nodiscard]] std::string fit_model(const CpsdSums& sums, const IdentifierConfig& config,
                                    const std::vector<ChannelInfo>& channels, ModelFit& out);

// Channels that share the rows: the camera's rotation is an input without dynamics to be resolved.
[[nodiscard]] std::size_t n_resolved(const std::vector<ChannelInfo>& channels);

// More block rows than this fit has, for lines closer than their widths; 0 where the configuration fixes them, or where
// the record or the time of an update has no room for more.
[[nodiscard]] int longer_block_rows(const CpsdSums& sums, const IdentifierConfig& config, const ModelFit& fit,
                                    const std::vector<ChannelInfo>& channels);

}  // namespace core
