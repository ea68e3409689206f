#include "tools/hovermodal/export/run_spectra.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/identification/correlation.h"
#include "core/spectrum/welch_cpsd.h"

namespace tools {
namespace {

constexpr std::size_t kAllPairsChannels = 16;
constexpr int kLeastExportSegment = 16;
using Pairs = std::vector<std::pair<int, int>>;

core::CpsdSums sums_of(const app::ChannelSeries& series, int segment) {
  core::WelchConfig config;
  config.n_channels = static_cast<int>(series.channels.size());
  config.segment = segment;
  config.rate_hz = series.rate_hz;
  config.n_blocks = 0;
  config.gate_outliers = true;
  core::WelchCpsd welch(config);
  std::vector<double> value(series.channels.size());
  std::vector<std::uint8_t> seen(series.channels.size());
  for (std::size_t t = 0; t < series.value.front().size(); ++t) {
    for (std::size_t c = 0; c < value.size(); ++c) {
      value[c] = series.value[c][t];
      seen[c] = std::isfinite(value[c]) ? 1 : 0;
    }
    (void)welch.push(value, seen);
  }
  welch.flush();
  return welch.sums();
}

std::size_t at(const core::CpsdSums& sums, int bin, int i, int j) {
  return static_cast<std::size_t>(bin) * static_cast<std::size_t>(sums.n_pairs()) +
         static_cast<std::size_t>(core::CpsdSums::pair_index(i, j, sums.n_channels));
}

// Sum of w^2 over all samples that both channels have: by Parseval from the masks' spectrum.
double seen_power(const core::CpsdSums& sums, int i, int j) {
  double sum = 0.0;
  for (int k = 0; k < sums.n_bins(); ++k)
    sum += (k == 0 || 2 * k == sums.n_fft ? 1.0 : 2.0) * sums.mask_sum[at(sums, k, i, j)].real();
  return sum / sums.n_fft;
}

Pairs pairs_of(const core::CpsdSums& sums) {
  Pairs out;
  const int n = sums.n_channels;
  if (static_cast<std::size_t>(n) <= kAllPairsChannels) {
    for (int i = 0; i < n; ++i) {
      for (int j = i; j < n; ++j) out.emplace_back(i, j);
    }
    return out;
  }
  const auto power = [&](int c) {
    double sum = 0.0;
    for (int k = 1; k < sums.n_bins(); ++k) sum += sums.data_sum[at(sums, k, c, c)].real();
    return sum;
  };
  int strongest = 0;
  double most = -1.0;
  for (int c = 0; c < n; ++c) {
    if (const double own = power(c); own > most) most = own, strongest = c;
  }
  for (int c = 0; c < n; ++c) {
    out.emplace_back(c, c);
    if (c != strongest) out.emplace_back(std::min(c, strongest), std::max(c, strongest));
  }
  return out;
}

drivers::ExchangePair density(const core::CpsdSums& sums, int i, int j) {
  drivers::ExchangePair out{static_cast<std::size_t>(i), static_cast<std::size_t>(j), {}};
  const double divisor = sums.rate_hz * seen_power(sums, i, j);
  for (int k = 0; k < sums.n_bins(); ++k) {
    const double sides = k == 0 || 2 * k == sums.n_fft ? 1.0 : 2.0;
    out.value.push_back(divisor > 0.0 ? sides * sums.data_sum[at(sums, k, i, j)] / divisor : 0.0);
  }
  return out;
}

}  // namespace

void add_spectra(const app::ChannelSeries& series, int segment, drivers::ExchangeRun& run,
                 std::vector<std::string>& remarks) {
  const auto n_samples = static_cast<int>(series.value.front().size());
  if (segment <= 0) segment = std::max(kLeastExportSegment, n_samples / 5);
  if (n_samples < segment || n_samples < kLeastExportSegment) {
    remarks.push_back(fmt::format("no spectra: {} samples are fewer than one segment of {}", n_samples, segment));
    return;
  }
  const core::CpsdSums sums = sums_of(series, segment);
  const Pairs pairs = pairs_of(sums);
  run.segment = segment;
  run.frequency_step_hz = sums.rate_hz / sums.n_fft;
  for (const auto& [i, j] : pairs) run.spectra.push_back(density(sums, i, j));

  core::Correlations correlations;
  run.most_lag = segment / 2;
  const core::CorrelationStatus status = core::compute_correlations(sums, run.most_lag, 0, correlations, {}, 0.0);
  if (status != core::CorrelationStatus::kOk) {
    remarks.push_back(fmt::format("no correlations: {}", core::to_string(status)));
    return;
  }
  for (const auto& [i, j] : pairs) {
    drivers::ExchangePair& out = run.correlations.emplace_back();
    out.i = static_cast<std::size_t>(i), out.j = static_cast<std::size_t>(j);
    for (int lag = -run.most_lag; lag <= run.most_lag; ++lag) out.value.emplace_back(correlations.divided(i, j, lag));
  }
}

}  // namespace tools
