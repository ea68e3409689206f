#pragma once

#include <string>
#include <vector>

#include "core/identification/correlation.h"
#include "core/identification/folding.h"
#include "core/identification/participation.h"
#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace core {

inline constexpr int kMostOrders = 15;  // of the stabilisation diagram, two apart
inline constexpr int kPublishedOrder = 36;

struct IdentifierConfig {
  std::vector<int> references;    // channel indices; empty = automatic
  int block_rows = 0;             // 0 = automatic
  int max_order = 0;              // 0 = automatic
  double max_frequency_hz = 0.0;  // true frequencies looked for; 0 = half the rate: nothing is unfolded
  double min_mpc = 0.8;
  double max_damping = 0.15;
  int n_differences = -1;  // prewhitening: 0, 1, -1 = as choose_differences() finds
  double edge_hz = 0.0;    // apparent frequencies above it lie in a filter's edge and are no modes; 0 = no filter
  double least_power = kLeastPowerMm2;  // a channel with less is taken to stand still; in the channels' unit squared
  bool undo_row_delays = true;          // false: the samples were compensated before (paper mode)
  // As Yoon et al. 2017 do it: plain ERA [Juang & Pappa 1985] of one order (max_order, 0 = kPublishedOrder), nothing
  // differenced, and a pole is a mode unless it is none of a vibration or the base moves with it.
  bool as_published = false;
};

// From the sums of a spectrum to modes with a verdict each: NExT, canonical-variate ERA, a stabilisation over orders
// (METHOD.md). A pure function of its arguments: same sums, same bits.
class Identifier {
 public:
  // channels: of the sums that will come; witnesses, if any, last: shapes are without them (camera_leakage.h).
  // Throws std::invalid_argument: a reference that is no channel, no channel at all.
  Identifier(IdentifierConfig config, std::vector<ChannelInfo> channels);

  // Fills modes, rejected, peaks, channels, model_order, status and what the sums know. Never throws on data; NaN never
  // leaves it. Channels with too little record take no part (participation.h): their components are 0 and stated as
  // unknown in ModalEstimate::channels.
  [[nodiscard]] ModalEstimate identify(const CpsdSums& sums) const;

  [[nodiscard]] const std::vector<ChannelInfo>& channels() const noexcept { return channels_; }
  [[nodiscard]] std::size_t n_outputs() const noexcept { return outputs_.size(); }  // of them no witnesses
  // Per channel, as it is undone at every mode; 0 where the samples were compensated before.
  [[nodiscard]] std::vector<double> undone_delay_s() const;

 private:
  [[nodiscard]] ModalEstimate identify_all(const CpsdSums& sums, const std::vector<ChannelRecord>& records) const;
  [[nodiscard]] ModalEstimate identify_kept(const CpsdSums& sums, const Participation& part) const;
  [[nodiscard]] Identifier with_channels(const std::vector<std::size_t>& kept) const;
  [[nodiscard]] std::vector<ChannelInfo> delays_as_undone() const;
  [[nodiscard]] FoldingConfig folding_config(double rate_hz) const;

  IdentifierConfig config_;
  std::vector<ChannelInfo> channels_, outputs_;
};

}  // namespace core
