#include "core/identification/correlation.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <span>

#include "core/spectrum/real_fft.h"

namespace core {

namespace {

// A lag seen fewer times than this share of lag 0 has no usable average.
constexpr double kLeastMaskShare = 1e-3;

class PairTransform {
 public:
  explicit PairTransform(const CpsdSums& sums)
      : sums_(sums), fft_(sums.n_fft), bins_(static_cast<std::size_t>(sums.n_bins())) {
    spectrum_.resize(bins_);
  }

  // Inverse transform of one pair's sum. out: n_fft circular lags.
  void inverse(const std::vector<std::complex<double>>& sum, int pair, std::vector<double>& out) {
    const auto pairs = static_cast<std::size_t>(sums_.n_pairs());
    for (std::size_t k = 0; k < bins_; ++k) spectrum_[k] = sum[k * pairs + static_cast<std::size_t>(pair)];
    finish(out);
  }

  // The same of the blocks' sums together.
  void inverse(std::span<const CpsdBlock> blocks, std::vector<std::complex<double>> CpsdBlock::*sum, int pair,
               std::vector<double>& out) {
    const auto pairs = static_cast<std::size_t>(sums_.n_pairs());
    std::fill(spectrum_.begin(), spectrum_.end(), std::complex<double>());
    for (const CpsdBlock& block : blocks) {
      for (std::size_t k = 0; k < bins_; ++k) spectrum_[k] += (block.*sum)[k * pairs + static_cast<std::size_t>(pair)];
    }
    finish(out);
  }

 private:
  void finish(std::vector<double>& out) {
    out.resize(static_cast<std::size_t>(sums_.n_fft));
    fft_.inverse(spectrum_, out);
  }

  const CpsdSums& sums_;
  RealFft fft_;
  std::size_t bins_;
  std::vector<std::complex<double>> spectrum_;
};

// R_d(lag) = 2 R(lag) - R(lag - 1) - R(lag + 1), n times; the ends are used up.
void difference(std::vector<double>& values, int n_differences) {
  for (int d = 0; d < n_differences; ++d) {
    for (std::size_t k = 0; k + 2 < values.size(); ++k) values[k] = 2.0 * values[k + 1] - values[k] - values[k + 2];
    values.resize(values.size() - 2);
  }
}

std::span<const CpsdBlock> group_of(const CpsdSums& sums, std::size_t group, std::size_t n_groups) {
  const std::size_t first = group * sums.n_blocks / n_groups, last = (group + 1) * sums.n_blocks / n_groups;
  return std::span(sums.blocks).subspan(first, last - first);
}

// Have all channels lacked the same samples, or none? Then one mask serves all pairs.
bool one_mask(const CpsdSums& sums) {
  const auto pairs = static_cast<std::size_t>(sums.n_pairs());
  for (std::size_t k = 0; k < sums.mask_sum.size(); k += pairs) {
    for (std::size_t pair = 1; pair < pairs; ++pair) {
      if (sums.mask_sum[k + pair] != sums.mask_sum[k]) return false;
    }
  }
  return true;
}

std::size_t circular(int lag, int n_fft) { return static_cast<std::size_t>(lag >= 0 ? lag : n_fft + lag); }

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
      difference(divided, n_differences);
      difference(undivided, n_differences);
      for (int lag = -max_lag; lag <= max_lag; ++lag) {
        const auto at = static_cast<std::size_t>(lag + max_lag);
        out.set(i, j, lag, divided[at], undivided[at]);
      }
    }
    if (!(out.undivided(i, i, 0) > least_power)) return CorrelationStatus::kNoPower;
  }
  return CorrelationStatus::kOk;
}

std::vector<Correlations> block_deviations(const CpsdSums& sums, int n_differences, int max_lag, std::size_t n_groups) {
  if (n_groups == 0 || sums.n_blocks < n_groups) return {};
  const int n = sums.n_channels, reach = max_lag + n_differences;
  std::vector<Correlations> out(n_groups, Correlations(n, max_lag));
  PairTransform transform(sums);
  const bool shared = one_mask(sums);
  std::vector<double> data, all_data, all_mask, moved;
  std::vector<std::vector<double>> mask(n_groups);
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) {
      const int pair = CpsdSums::pair_index(i, j, n);
      const bool same_mask = shared && pair > 0;
      transform.inverse(sums.data_sum, pair, all_data);
      if (!same_mask) transform.inverse(sums.mask_sum, pair, all_mask);
      for (std::size_t g = 0; g < n_groups; ++g) {
        const std::span<const CpsdBlock> part = group_of(sums, g, n_groups);
        transform.inverse(part, &CpsdBlock::data_sum, pair, data);
        if (!same_mask) transform.inverse(part, &CpsdBlock::mask_sum, pair, mask[g]);
        moved.clear();
        for (int lag = -reach; lag <= reach; ++lag) {
          const std::size_t at = circular(lag, sums.n_fft);
          moved.push_back((data[at] - all_data[at] / all_mask[at] * mask[g][at]) / all_mask[at]);
        }
        difference(moved, n_differences);
        for (int lag = -max_lag; lag <= max_lag; ++lag) {
          out[g].set(i, j, lag, moved[static_cast<std::size_t>(lag + max_lag)], 0.0);
        }
      }
    }
  }
  return out;
}

}  // namespace core
