#pragma once

#include <cstddef>
#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace core {

// Selects the channels with enough record to be identified together (METHOD.md). Cross-spectra are averages over the
// samples that both channels have. If a channel was observed in one stretch only, its spectra are those of that
// stretch, and together with the other channels' they do not describe a single system: a mode splits in two, one of
// them in that channel alone. Such a channel is excluded, and its component of every shape is unknown. Losses spread
// evenly over the record do no harm.
struct Participation {
  std::vector<ChannelRecord> records;  // per channel of the sums
  std::vector<std::size_t> kept;       // channels that take part, ascending
  [[nodiscard]] bool all() const noexcept { return kept.size() == records.size(); }
};

// channels: those of the sums. A pure function.
[[nodiscard]] Participation participation(const CpsdSums& sums, const std::vector<ChannelInfo>& channels);

// Share of a shape's square in one channel above which the mode is taken to move in that channel alone.
inline constexpr double kAlone = 0.9;
// A channel with less of the record is partly masked.
inline constexpr double kWholeRecord = 0.95;

// Partly masked channel in which alone the shape moves; -1: none, or too few channels to decide.
[[nodiscard]] int lone_masked_channel(const std::vector<std::complex<double>>& shape,
                                      const std::vector<ChannelRecord>& records);

}  // namespace core
