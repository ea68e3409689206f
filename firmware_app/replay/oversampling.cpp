#include "firmware_app/replay/oversampling.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "core/linear/median.h"
#include "core/spectrum/decimator.h"
#include "core/spectrum/welch_cpsd.h"
#include "core/types/constants.h"
#include "firmware_app/replay/series_channels.h"

namespace app {

namespace {

constexpr double kShare = 0.99;       // of the velocity's power
constexpr double kLeastPower = 1e-5;  // of the strongest acceleration's
constexpr double kMargin = 1.25;      // of the limit that is proposed or used
constexpr int kLeastFactor = 4;
constexpr double kNoiseScatter = 2.0;  // of the mean of ...
constexpr int kBinsTogether = 16;      // ... so many bins, in a spectrum of few segments
constexpr int kFirstBin = 2;           // below, an acceleration's integral is its offset's
constexpr std::size_t kLongestSegment = 1 << 16;

double power_of(const core::CpsdSums& sums, int channel, int bin) {
  const auto pair = static_cast<std::size_t>(core::CpsdSums::pair_index(channel, channel, sums.n_channels));
  return sums.data_sum[static_cast<std::size_t>(bin) * static_cast<std::size_t>(sums.n_pairs()) + pair].real();
}

// The median of the upper half of the bins below n_bins.
double noise_of(const core::CpsdSums& sums, int channel, int n_bins) {
  std::vector<double> upper;
  for (int bin = n_bins / 2; bin < n_bins; ++bin) upper.push_back(power_of(sums, channel, bin));
  return core::median(upper);
}

// Power of the motion's derivative of that order, in each bin below n_bins, without noise that is white there in the
// record's own quantity.
std::vector<double> motion_of(const core::CpsdSums& sums, int channel, int n_bins, int n_integrations, int derivative) {
  const double noise = kNoiseScatter * noise_of(sums, channel, n_bins);
  std::vector<double> out(static_cast<std::size_t>(n_bins), 0.0);
  for (int first = kFirstBin; first < n_bins; first += kBinsTogether) {
    const int last = std::min(first + kBinsTogether, n_bins);
    double mean = 0.0;
    for (int bin = first; bin < last; ++bin) mean += power_of(sums, channel, bin) / (last - first);
    for (int bin = first; bin < last && mean > noise; ++bin) {
      const double w = core::kTwoPi * bin * sums.rate_hz / sums.n_fft;
      out[static_cast<std::size_t>(bin)] =
          power_of(sums, channel, bin) * std::pow(w, 2.0 * (derivative - n_integrations));
    }
  }
  return out;
}

core::CpsdSums spectrum_of(const std::vector<double>& values, double rate_hz) {
  const std::size_t eighth = std::bit_floor(std::max<std::size_t>(values.size() / 8, 64));
  core::WelchConfig config;
  config.n_channels = 1, config.n_blocks = 0, config.rate_hz = rate_hz;
  config.segment = static_cast<int>(std::min(eighth, kLongestSegment));
  core::WelchCpsd cpsd(config);
  for (const double value : values) {
    const std::uint8_t seen = std::isfinite(value) ? 1 : 0;
    (void)cpsd.push({&value, 1}, {&seen, 1});
  }
  cpsd.flush();
  return cpsd.sums();
}

// Bins of the only channel up to the last one that moves, of those below n_bins; 0 = nothing moves.
int moving_bins(const core::CpsdSums& sums, int n_bins, int n_integrations) {
  const std::vector<double> power = motion_of(sums, 0, n_bins, n_integrations, 2);
  // Means, because one bin of few segments says little.
  std::vector<double> bands;
  for (int first = kFirstBin; first < n_bins; first += kBinsTogether) {
    const int last = std::min(first + kBinsTogether, n_bins);
    bands.push_back(std::accumulate(power.begin() + first, power.begin() + last, 0.0) / (last - first));
  }
  const double least = bands.empty() ? 0.0 : kLeastPower * *std::max_element(bands.begin(), bands.end());
  const auto top = std::find_if(bands.rbegin(), bands.rend(), [&](double mean) { return mean > least; });
  const auto n_bands = static_cast<int>(bands.rend() - top);
  return n_bands == 0 ? 0 : std::min(kFirstBin + kBinsTogether * n_bands, n_bins);
}

double channel_moves_up_to_hz(const std::vector<double>& values, double rate_hz, int n_integrations) {
  const core::CpsdSums sums = spectrum_of(values, rate_hz);
  int n_bins = sums.n_bins(), top = moving_bins(sums, n_bins, n_integrations);
  if (top == 0) return 0.0;
  // A filter may have cut the noise, too: it is then white below that limit alone.
  while (top > 0 && kLeastFactor * top <= n_bins) {
    n_bins = top;
    top = moving_bins(sums, n_bins, n_integrations);
  }
  return n_bins * rate_hz / sums.n_fft;
}

// 99 % of the velocity's power lie below.
double velocity_up_to_hz(const core::CpsdSums& sums, const std::vector<core::ChannelInfo>& channels) {
  int last = 0;
  for (int c = 0; c < sums.n_channels && c < static_cast<int>(channels.size()); ++c) {
    const std::vector<double> power =
        motion_of(sums, c, sums.n_bins(), channels[static_cast<std::size_t>(c)].n_integrations, 1);
    const double whole = std::accumulate(power.begin(), power.end(), 0.0);
    double so_far = 0.0;
    for (int bin = kFirstBin; bin < sums.n_bins() && so_far < kShare * whole; ++bin) {
      so_far += power[static_cast<std::size_t>(bin)];
      last = std::max(last, bin);
    }
  }
  return last * sums.rate_hz / sums.n_fft;
}

// Above, no channel moves: its power is no more than white noise, or 50 dB below the channel's strongest, as
// acceleration. Half the rate where the motion takes more than a quarter of the spectrum. 0 = nothing moves.
double moves_up_to_hz(const ChannelSeries& series) {
  double out = 0.0;
  for (std::size_t c = 0; c < series.channels.size(); ++c) {
    out = std::max(out, channel_moves_up_to_hz(series.value[c], series.rate_hz, series.channels[c].n_integrations));
  }
  return out;
}

}  // namespace

int decimate_to_motion(ChannelSeries& series, std::vector<std::string>& remarks) {
  const double moves_hz = moves_up_to_hz(series), limit_hz = kMargin * moves_hz;
  if (!(limit_hz > 0.0) || core::decimation_factor(series.rate_hz, limit_hz) < kLeastFactor) return 1;
  remarks.push_back(
      fmt::format("nothing moves above {:.3g} Hz, far below half the rate of {:g} Hz; --max-frequency "
                  "sets another limit",
                  moves_hz, series.rate_hz));
  return decimate_to(series, limit_hz, remarks);
}

std::string remark_on_oversampling(const core::CpsdSums& sums, const std::vector<core::ChannelInfo>& channels) {
  const double limit_hz = velocity_up_to_hz(sums, channels);
  if (!(limit_hz > 0.0) || core::decimation_factor(sums.rate_hz, kMargin * limit_hz) < kLeastFactor) return {};
  return fmt::format(
      "99 % of the motion (power of the velocity) lies below {:.3g} Hz, far below half the rate of {:g} Hz: the "
      "window "
      "is short for such modes; identify with --max-frequency {:.3g} as well",
      limit_hz, sums.rate_hz, kMargin * limit_hz);
}

}  // namespace app
