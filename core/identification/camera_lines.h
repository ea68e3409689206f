#pragma once

#include <complex>
#include <vector>

#include "core/identification/folding.h"
#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace core {

// A line of the camera's own vibration (rotors, a gimbal). Its frequency may wander by some tenths of a hertz.
struct CameraLine {
  double apparent_hz = 0.0;
  double half_width_hz = 0.0;
  double height = 0.0;  // power over that of the spectrum to either side; by the rows, over that of other orders, too
  bool of_the_region = false;  // seen in the spectrum of a static region; otherwise by the rows' phases
  // Signed frequencies whose row delays give this motion, by magnitude: those that the rows do not distinguish.
  // Empty: none does, or there are too few rows.
  std::vector<double> true_hz;
  double margin = 0.0;                       // of the best of them over the second best, 0 ... 1
  std::vector<std::complex<double>> motion;  // of every output, in any unit
};

inline constexpr std::size_t kMostCameraLines = 4;
inline constexpr std::size_t kMostTrueFrequencies = 3;  // that the rows may leave open

// In all of these: channels: of the sums, witnesses last, with the row delays that the samples still have; folding:
// delays of the outputs. Deterministic.

// Narrow peaks in the spectra of static regions. What the outputs do with them comes from their cross-spectrum, with
// which the structure's own motion is not coherent; from its phases over the rows follows the true frequency.
[[nodiscard]] std::vector<CameraLine> lines_of_static_regions(const CpsdSums& sums,
                                                              const std::vector<ChannelInfo>& channels,
                                                              const FoldingConfig& folding);

// Motion that all rows share with the phases of a frequency beyond the search range: the minimum-variance spectrum
// [Capon 1969] of the rows as an array of sensors, of every alias order. It suppresses what the structure and the slow
// camera do at the same apparent frequency, and needs no static region. modes_hz: apparent frequencies near which
// a line must be clearer.
[[nodiscard]] std::vector<CameraLine> lines_by_row_phases(const CpsdSums& sums,
                                                          const std::vector<ChannelInfo>& channels,
                                                          const FoldingConfig& folding,
                                                          const std::vector<double>& modes_hz);

// Lists both kinds in `rejected`, from four segments of at least four seconds on, as poles without damping that are
// motion of the camera, at most kMostCameraLines. Where such a pole is listed, its reason gets the true frequency
// instead.
void list_camera_lines(const CpsdSums& sums, const std::vector<ChannelInfo>& channels, const FoldingConfig& folding,
                       ModalEstimate& estimate);

}  // namespace core
