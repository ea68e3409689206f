#include "core/identification/correlation.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/identification/pair_transform.h"

namespace core {

namespace {

// A lag with less than this share of the sample pairs of lag 0 has no usable average.
constexpr double kLeastMaskShare = 1e-3;

}  // namespace

Correlations::Correlations(int n_channels, int max_lag) : n_channels_(n_channels), max_lag_(max_lag) {
  const auto pairs = static_cast<std::size_t>(n_channels) * static_cast<std::size_t>(n_channels + 1) / 2;
  divided_.assign(pairs * static_cast<std::size_t>(2 * max_lag + 1), 0.0);
  undivided_ = divided_;
}

const char* to_string(CorrelationStatus status) noexcept {
  switch (status) {
    case CorrelationStatus::kOk:
      return "ok";
    case CorrelationStatus::kNoSegment:
      return "not one full segment yet";
    case CorrelationStatus::kNotFinite:
      return "the spectra are not finite";
    case CorrelationStatus::kNoPower:
      return "a channel has no motion or no samples at all";
    case CorrelationStatus::kTooFewSamples:
      return "too many samples are missing: some lags were never seen";
  }
  return "";
}

CorrelationStatus compute_correlations(const CpsdSums& sums, int max_lag, int n_differences, Correlations& out,
                                       std::span<const int> references, double least_power) {
  if (sums.n_segments == 0) return CorrelationStatus::kNoSegment;
  const int n = sums.n_channels;
  max_lag = std::min(max_lag, sums.n_fft / 2 - 1 - n_differences);
  out = Correlations(n, max_lag);
  PairTransform transform(sums);
  const bool shared_mask = one_mask(sums);
  const auto is_wanted = [&](int i, int j) {
    return references.empty() || i == j ||
           std::any_of(references.begin(), references.end(), [&](int r) { return r == i || r == j; });
  };
  std::vector<double> data, mask, divided, undivided;
  std::vector<double> mask_at_0(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    if (i == 0 || !shared_mask) transform.inverse(sums.mask_sum, CpsdSums::pair_index(i, i, n), mask);
    mask_at_0[static_cast<std::size_t>(i)] = mask[0];
    if (!(mask[0] > 0.0)) return CorrelationStatus::kNoPower;
  }
  const int reach = max_lag + n_differences;
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) {
      if (!is_wanted(i, j)) continue;
      const int pair = CpsdSums::pair_index(i, j, n);
      transform.inverse(sums.data_sum, pair, data);
      if (!shared_mask) transform.inverse(sums.mask_sum, pair, mask);
      // One positive scale per channel keeps the undivided estimate positive semidefinite under unequal losses.
      const double scale = std::sqrt(mask_at_0[static_cast<std::size_t>(i)] * mask_at_0[static_cast<std::size_t>(j)]);
      divided.clear();
      undivided.clear();
      for (int lag = -reach; lag <= reach; ++lag) {
        const std::size_t at = circular(lag, sums.n_fft);
        if (!std::isfinite(data[at])) return CorrelationStatus::kNotFinite;
        if (mask[at] < kLeastMaskShare * scale) return CorrelationStatus::kTooFewSamples;
        divided.push_back(data[at] / mask[at]);
        undivided.push_back(data[at] / scale);
      }
      difference_lags(divided, n_differences);
      difference_lags(undivided, n_differences);
      for (int lag = -max_lag; lag <= max_lag; ++lag) {
        const auto at = static_cast<std::size_t>(lag + max_lag);
        out.set(i, j, lag, divided[at], undivided[at]);
      }
    }
    if (!(out.undivided(i, i, 0) > least_power)) return CorrelationStatus::kNoPower;
  }
  return CorrelationStatus::kOk;
}

}  // namespace core
