#pragma once

#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace core {

// A rolling shutter turns the phases of a real shape by the time at which each row is seen. The readout time that makes
// the shapes of all modes real again is therefore that of the sensor, found without any clock (ARCHITECTURE.md).

// A pole as the samples show it: apparent frequency 0 .. rate / 2, shape with the delays still in it.
struct ObservedPole {
  double apparent_hz = 0.0;
  std::vector<std::complex<double>> shape;
  std::vector<double> shape_std;  // per component; empty = unknown
};

// Puts the row delays of `channels` back into a mode's shape.
[[nodiscard]] ObservedPole observed_pole(const Mode& mode, const std::vector<ChannelInfo>& channels, double rate_hz);

struct ReadoutSearch {
  double rate_hz = 0.0;
  double max_frequency_hz = 0.0;  // of modes; at least half the rate
  double most_frames = 1.0;       // readout times looked for: -most .. most, in frames (negative: read upwards)
};

struct ReadoutFromShapes {
  double readout_frames = 0.0;
  double std_frames = 0.0;     // the larger of the jackknife over the poles and what their shapes' scatter implies
  bool scatter_known = false;  // of at least two poles' shapes; without it a flat maximum may look sharp
  double mean_mpc = 0.0;       // of the poles' best hypotheses at that readout, 0..1
  int n_poles = 0;
};

// row_share: the part of the readout that has passed when each channel is seen, 0..1. Maximises the mean over the poles
// of the best MPC over the folds. Empty: fewer than two poles of three components, rows too close together, or sizes
// that do not fit. Poles above half the rate tell most; slow ones hardly anything.
[[nodiscard]] std::optional<ReadoutFromShapes> readout_from_shapes(std::span<const ObservedPole> poles,
                                                                   std::span<const double> row_share,
                                                                   const ReadoutSearch& search);

}  // namespace core
