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

class FieldShapes;  // field_shapes.h

inline constexpr int kMostOrders = 15;  // of the stabilisation diagram, in steps of two
inline constexpr int kPublishedOrder = 36;

struct IdentifierConfig {
  std::vector<int> references;    // channel indices; empty = automatic
  int block_rows = 0;             // 0 = automatic
  int max_order = 0;              // 0 = automatic
  double max_frequency_hz = 0.0;  // highest true frequency to be found; 0 = half the rate: nothing is unfolded
  double min_mpc = 0.8;
  double max_damping = 0.15;
  int n_differences = -1;  // prewhitening: 0, 1, -1 = result of choose_differences()
  double edge_hz = 0.0;    // upper limit of apparent frequencies: above is a filter's transition band; 0 = none
  double least_power = kLeastPowerMm2;  // a channel with less power counts as static; in the channels' unit squared
  bool undo_row_delays = true;          // false: the samples are already compensated (paper mode)
  // Method of Yoon et al. 2017: plain ERA [Juang & Pappa 1985] of one order (max_order, 0 = kPublishedOrder) without
  // differences. A pole is a mode unless it is not a vibration or the base moves with it.
  bool as_published = false;
};

// Identifies modes, each with a verdict, from spectral sums: NExT, canonical-variate ERA, stabilisation over orders
// (METHOD.md). A pure function of its arguments: equal sums give bit-identical results.
class Identifier {
 public:
  // channels: of the sums that will be identified; witnesses, if any, last: shapes do not contain them
  // (camera_leakage.h). Throws std::invalid_argument: a reference that is not a channel, or no channels.
  Identifier(IdentifierConfig config, std::vector<ChannelInfo> channels);

  // Fills modes, rejected, peaks, channels, model_order, status and the fields taken from the sums. Never throws on
  // data; never returns NaN. Channels with too little record are excluded (participation.h): their components are 0 and
  // marked as unknown in ModalEstimate::channels.
  [[nodiscard]] ModalEstimate identify(const CpsdSums& sums) const;
  // The same, and what further channels of this record need for their components of modes and rejected, in that order.
  // Not with static regions, nor with a channel that is excluded: throws std::invalid_argument.
  [[nodiscard]] ModalEstimate identify(const CpsdSums& sums, FieldShapes& field) const;

  [[nodiscard]] const std::vector<ChannelInfo>& channels() const noexcept { return channels_; }
  [[nodiscard]] std::size_t n_outputs() const noexcept { return outputs_.size(); }  // witnesses excluded
  // Row delay per channel that is removed from every mode; 0 if the samples were compensated before.
  [[nodiscard]] std::vector<double> undone_delay_s() const;

 private:
  [[nodiscard]] ModalEstimate identify_all(const CpsdSums& sums, const std::vector<ChannelRecord>& records,
                                           FieldShapes* field) const;
  void identify_modes(const CpsdSums& sums, const std::vector<ChannelRecord>& records, FieldShapes* field,
                      ModalEstimate& estimate) const;
  // Where the camera shares a mode (SharedMotion), replaces the modes by those of the motion relative to the base: the
  // region at rest, an input, is then coherent with the force, and what it explains away distorts damping and shapes.
  void identify_shared(const CpsdSums& sums, const std::vector<ChannelRecord>& records, ModalEstimate& estimate) const;
  [[nodiscard]] ModalEstimate identify_kept(const CpsdSums& sums, const Participation& part, FieldShapes* field) const;
  [[nodiscard]] ModalEstimate identify(const CpsdSums& sums, FieldShapes* field) const;
  [[nodiscard]] Identifier with_channels(const std::vector<std::size_t>& kept) const;
  [[nodiscard]] std::vector<ChannelInfo> delays_as_undone() const;
  [[nodiscard]] FoldingConfig folding_config(double rate_hz) const;

  IdentifierConfig config_;
  std::vector<ChannelInfo> channels_, outputs_;
};

}  // namespace core
