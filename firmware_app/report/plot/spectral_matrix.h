#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "core/types/cpsd.h"
#include "core/types/modal_estimate.h"

namespace app {

// One frequency line of the spectral matrix (channels x channels, Hermitian, positive semidefinite), decomposed:
// Brincker, Zhang & Andersen 2001. In the displacement's unit squared per Hz.
struct SpectralLine {
  double frequency_hz = 0.0;
  std::vector<double> singular;             // the largest first, at most kMaxSingular
  double share = 0.0;                       // of the first in the sum of all, 0..1: 1 = one shape moves
  std::vector<std::complex<double>> shape;  // first singular vector, per channel; the largest component is 1
};
inline constexpr std::size_t kMaxSingular = 4;

struct SpectralLines {
  std::vector<SpectralLine> lines;    // ascending; empty = nothing to show
  std::vector<std::size_t> channels;  // of the matrix; the others take no part, their component is 0
  std::size_t n_singular = 0;         // of every line: as many as there are channels or segments
  // The line nearest to a frequency; needs one line.
  [[nodiscard]] std::size_t nearest(double frequency_hz) const noexcept;
};

// Decomposes the lines that a picture of the summed spectrum shows: where there are more bins than can be drawn, the
// highest and lowest of each stretch. Time and memory are bounded whatever the numbers of channels and bins. A line
// with a value that is not finite is left out. `estimate`, null or not, says which channels take part.
[[nodiscard]] SpectralLines spectral_lines(const core::CpsdSums* sums, const core::ModalEstimate* estimate);

}  // namespace app
