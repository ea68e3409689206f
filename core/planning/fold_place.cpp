#include "core/planning/fold_place.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/identification/verdict.h"

namespace core::planning {
namespace {

using Complex = std::complex<double>;

std::vector<double> rivals_hz(double apparent_hz, int n, const FoldingConfig& folding) {
  std::vector<double> out;
  if (folding.max_frequency_hz <= folding.rate_hz / 2.0) return out;  // the identification does not unfold in this case
  const int reach = static_cast<int>(std::ceil(folding.max_frequency_hz / folding.rate_hz)) + 1;
  for (int other = -reach; other <= reach; ++other) {
    const double frequency_hz = std::abs(apparent_hz + other * folding.rate_hz);
    if (other != n && frequency_hz <= folding.max_frequency_hz) out.push_back(frequency_hz);
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

FoldPlace fold_place(double frequency_hz, double damping_ratio, const std::vector<double>& shape,
                     const FoldingConfig& folding) {
  const double w = 2.0 * std::numbers::pi * frequency_hz;
  const Complex s(-damping_ratio * w, w * std::sqrt(1.0 - damping_ratio * damping_ratio));
  Complex lambda = std::exp(s / folding.rate_hz);
  std::vector<Complex> seen;
  for (std::size_t c = 0; c < shape.size(); ++c) seen.push_back(shape[c] * std::exp(s * folding.delay_s[c]));
  const bool mirrored = lambda.imag() < 0.0;
  if (mirrored) {
    lambda = std::conj(lambda);
    for (Complex& z : seen) z = std::conj(z);
  }
  const UnfoldedPole pole = unfold(lambda, seen, folding);
  FoldPlace place;
  place.apparent_hz = pole.apparent_hz;
  const double signed_hz = (mirrored ? -1.0 : 1.0) * s.imag() / (2.0 * std::numbers::pi);
  place.n = static_cast<int>(std::lround((signed_hz - pole.apparent_hz) / folding.rate_hz));
  place.rivals_hz = rivals_hz(place.apparent_hz, place.n, folding);
  place.margin = pole.fold_margin;
  if (place.rivals_hz.empty()) return place;
  const VerdictRules rules;
  if (!pole.fold_n) {
    place.outlook = FoldOutlook::kNoDelays;
  } else if (*pole.fold_n != place.n || *pole.fold_margin < rules.least_fold_margin) {
    place.outlook = FoldOutlook::kAmbiguous;
  } else {
    place.outlook = FoldOutlook::kResolved;
  }
  return place;
}

std::vector<Overlap> overlaps(const std::vector<double>& apparent_hz, const std::vector<double>& half_power_hz) {
  std::vector<Overlap> out;
  for (std::size_t a = 0; a < apparent_hz.size(); ++a) {
    for (std::size_t b = a + 1; b < apparent_hz.size(); ++b) {
      const double gap_hz = std::abs(apparent_hz[a] - apparent_hz[b]);
      const double width_hz = 0.5 * (half_power_hz[a] + half_power_hz[b]);
      if (gap_hz < width_hz) out.push_back({a, b, gap_hz, width_hz, gap_hz < 0.5 * width_hz});
    }
  }
  return out;
}

bool at_edge(double apparent_hz, double half_power_hz, double rate_hz) noexcept {
  return apparent_hz < 0.5 * half_power_hz || 0.5 * rate_hz - apparent_hz < 0.5 * half_power_hz;
}

}  // namespace core::planning
