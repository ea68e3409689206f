#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace core {

// Extended modal amplitude coherence of the outputs (Pappa, Elliott & Schenk 1993): tests whether a mode's shape at the
// end of the Hankel matrix's window equals the one at its beginning times the mode's own decay. Per channel: the ratio
// of the two magnitudes, smaller over larger, times 1 - |phase between them| / (pi / 4), at least 0; then the mean over
// the channels, weighted by the square of the shape. first, last: the shape in the first and the last block row; decay:
// lambda to the power of the block rows between. CMI, the consistent-mode indicator, is EMAC times MPC.
[[nodiscard]] inline double output_emac(const std::vector<std::complex<double>>& first,
                                        const std::vector<std::complex<double>>& last, std::complex<double> decay) {
  double sum = 0.0, weight = 0.0;
  for (std::size_t c = 0; c < first.size() && c < last.size(); ++c) {
    const std::complex<double> expected = first[c] * decay;
    const double a = std::abs(expected), b = std::abs(last[c]), square = std::norm(first[c]);
    weight += square;
    if (!(a > 0.0 && b > 0.0)) continue;
    const double phase = std::abs(std::arg(last[c] * std::conj(expected)));
    sum += square * std::min(a, b) / std::max(a, b) * std::max(0.0, 1.0 - phase / (0.25 * std::numbers::pi));
  }
  const double out = weight > 0.0 ? sum / weight : 0.0;
  return std::isfinite(out) ? out : 0.0;
}

}  // namespace core
