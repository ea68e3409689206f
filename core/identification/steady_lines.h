#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"

namespace core {

// A steady line: a machine, a rotor, the flicker of a lamp. Its phase advances by the same angle from segment to
// segment over the whole record, where that of a mode wanders within 1 / (2 pi zeta f).
struct SteadyLine {
  double apparent_hz = 0.0;
  // Share of the power at its bin that a line of constant amplitude and frequency explains, 0 ... 1, over all channels
  // and after what the measured inputs explain was taken out.
  double coherence = 0.0;
  std::uint64_t n_segments = 0;  // over which the coherence was taken
  std::vector<std::complex<double>>
      amplitude;  // per channel, mm: 2 Re(amplitude exp(i w t)), t from the stream's start
};

inline constexpr int kLeastLineSegments = 8;
inline constexpr std::size_t kMostSteadyLines = 6;

// The strongest first. inputs: channels that are measured inputs (measured_inputs.h); a line has no part in them. Empty
// where the sums keep fewer than kLeastLineSegments segments, or where a mode with a damping ratio of 0.1 % would be as
// coherent within this record. Deterministic.
[[nodiscard]] std::vector<SteadyLine> find_steady_lines(const CpsdSums& sums, const std::vector<ChannelInfo>& channels,
                                                        const std::vector<int>& inputs);

// The sums as if the lines had not been there. Exact for the segments that are kept; from older ones the lines' own
// power is taken.
[[nodiscard]] CpsdSums without_lines(const CpsdSums& sums, const std::vector<SteadyLine>& lines);

}  // namespace core
