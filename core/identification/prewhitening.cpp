#include "core/identification/prewhitening.h"

#include <algorithm>
#include <cstddef>

namespace core {

namespace {

constexpr int kDriftBins = 20;  // ten cycles per segment: the transform is twice as long as a segment
constexpr double kMostDrift = 0.5;

double drift_share(const CpsdSums& sums, int channel) noexcept {
  const auto pairs = static_cast<std::size_t>(sums.n_pairs());
  const auto pair = static_cast<std::size_t>(CpsdSums::pair_index(channel, channel, sums.n_channels));
  double slow = 0.0, whole = 0.0;
  for (int k = 0; k < sums.n_bins(); ++k) {
    const double power = sums.data_sum[static_cast<std::size_t>(k) * pairs + pair].real();
    whole += power;
    if (k <= kDriftBins) slow += power;
  }
  return whole > 0.0 ? slow / whole : 0.0;
}

}  // namespace

int choose_differences(const CpsdSums& sums, double max_frequency_hz) noexcept {
  if (sums.rate_hz > 0.0 && max_frequency_hz > 0.5 * sums.rate_hz) return 1;
  double share = 0.0;
  for (int c = 0; c < sums.n_channels; ++c) share += drift_share(sums, c) / std::max(1, sums.n_channels);
  return share > kMostDrift ? 1 : 0;
}

}  // namespace core
