#pragma once

#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace core {

// A rolling shutter rotates the phases of a real shape by the time at which each row is seen. The readout time of the
// sensor is estimated as the one that makes the shapes of all modes real; no clock is needed (METHOD.md).

// A pole as observed in the samples: apparent frequency 0 .. rate / 2, shape including the delays.
struct ObservedPole {
  double apparent_hz = 0.0;
  std::vector<std::complex<double>> shape;
  std::vector<double> shape_std;  // per component; empty = unknown
};

// The pole as observed: the row delays of `channels` are restored in the mode's shape.
[[nodiscard]] ObservedPole observed_pole(const Mode& mode, const std::vector<ChannelInfo>& channels, double rate_hz);

struct ReadoutSearch {
  double rate_hz = 0.0;
  double max_frequency_hz = 0.0;  // highest frequency of modes; at least half the rate
  double most_frames = 1.0;       // search range of the readout time: -most .. most, in frames (negative: read upwards)
};

struct ReadoutFromShapes {
  double readout_frames = 0.0;
  double std_frames = 0.0;     // the larger of the jackknife over the poles and the value from their shapes' sigma
  bool scatter_known = false;  // known for at least two poles; otherwise a flat maximum may look sharp
  double mean_mpc = 0.0;       // of the poles' best hypotheses at that readout time, 0..1
  int n_poles = 0;
};

// row_share: readout fraction of each channel, 0..1. Maximises the mean over the poles of the best MPC over the alias
// orders. Empty: fewer than two poles of three components, rows too close together, or inconsistent sizes. Poles above
// half the rate are most informative; slow ones contribute almost nothing.
[[nodiscard]] std::optional<ReadoutFromShapes> readout_from_shapes(std::span<const ObservedPole> poles,
                                                                   std::span<const double> row_share,
                                                                   const ReadoutSearch& search);

}  // namespace core
