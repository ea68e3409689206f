#pragma once

#include <string>
#include <vector>

#include "core/identification/era.h"
#include "core/identification/folding.h"
#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace core {

struct IdentifierConfig {
  std::vector<int> references;    // channel indices; empty = automatic
  int block_rows = 0;             // 0 = automatic
  int max_order = 0;              // 0 = automatic
  double max_frequency_hz = 0.0;  // true frequencies looked for; 0 = half the rate: nothing is unfolded
  double min_mpc = 0.8;
  double max_damping = 0.15;
  int n_differences = 1;        // prewhitening; 0 for channels without drift
  bool undo_row_delays = true;  // false: the samples were compensated before (paper mode)
};

// From the sums of a spectrum to modes with a verdict each: NExT, canonical-variate ERA, a stabilisation over orders
// (ARCHITECTURE.md). A pure function of its arguments: same sums, same bits.
class Identifier {
 public:
  // Throws std::invalid_argument: a reference that is no channel, no channel at all.
  Identifier(IdentifierConfig config, std::vector<ChannelInfo> channels);

  // Fills modes, rejected, model_order, status and what the sums know. Never throws on data; NaN never leaves it.
  [[nodiscard]] ModalEstimate identify(const CpsdSums& sums) const;

  [[nodiscard]] const std::vector<ChannelInfo>& channels() const noexcept { return channels_; }

 private:
  [[nodiscard]] int choose_block_rows(const CpsdSums& sums) const noexcept;
  [[nodiscard]] std::vector<int> choose_references() const;
  [[nodiscard]] EraConfig era_config(const CpsdSums& sums) const;
  [[nodiscard]] FoldingConfig folding_config(double rate_hz) const;

  IdentifierConfig config_;
  std::vector<ChannelInfo> channels_;
};

}  // namespace core
