#pragma once

#include <cstddef>
#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace core {

// Which channels have record enough to be identified together (METHOD.md). Cross-spectra are averages over the samples
// that both channels have. Of a channel that was seen in one stretch only they are those of that stretch, and with the
// other channels' they describe no single system: a mode splits in two, one of them in that channel alone. Such a
// channel takes no part, and its component of every shape is unknown. Losses spread evenly over the record do no harm.
struct Participation {
  std::vector<ChannelRecord> records;  // per channel of the sums
  std::vector<std::size_t> kept;       // those that take part, ascending
  [[nodiscard]] bool all() const noexcept { return kept.size() == records.size(); }
};

// channels: of the sums; a pure function.
[[nodiscard]] Participation participation(const CpsdSums& sums, const std::vector<ChannelInfo>& channels);

// Share of a shape's square in one channel from which on a mode moves in that channel alone.
inline constexpr double kAlone = 0.9;
// A channel with less of the record is partly masked.
inline constexpr double kWholeRecord = 0.95;

// The channel in which alone the shape moves, and which is partly masked; -1: there is none, or too few channels to say.
[[nodiscard]] int lone_masked_channel(const std::vector<std::complex<double>>& shape,
                                      const std::vector<ChannelRecord>& records);

}  // namespace core
