#include "firmware_app/replay/oversampling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/linear/median.h"
#include "core/spectrum/decimator.h"
#include "core/types/constants.h"

namespace app {

namespace {

constexpr double kShare = 0.99;
constexpr double kMargin = 1.25;  // of the limit that is proposed
constexpr int kLeastFactor = 4;
constexpr double kNoiseScatter = 2.0;  // of the mean of ...
constexpr int kBinsTogether = 16;      // ... so many bins, in a spectrum of few segments
constexpr int kFirstBin = 2;           // below, an acceleration's integral is its offset's

double power_of(const core::CpsdSums& sums, int channel, int bin) {
  const auto pair = static_cast<std::size_t>(core::CpsdSums::pair_index(channel, channel, sums.n_channels));
  return sums.data_sum[static_cast<std::size_t>(bin) * static_cast<std::size_t>(sums.n_pairs()) + pair].real();
}

// The median of the upper half of the spectrum.
double noise_of(const core::CpsdSums& sums, int channel) {
  std::vector<double> upper;
  for (int bin = sums.n_bins() / 2; bin < sums.n_bins(); ++bin) upper.push_back(power_of(sums, channel, bin));
  return core::median(upper);
}

// Of the velocity, without noise that is white in the record's own quantity.
std::vector<double> motion_of(const core::CpsdSums& sums, int channel, int n_integrations) {
  const double noise = kNoiseScatter * noise_of(sums, channel);
  std::vector<double> out(static_cast<std::size_t>(sums.n_bins()), 0.0);
  for (int first = kFirstBin; first < sums.n_bins(); first += kBinsTogether) {
    const int last = std::min(first + kBinsTogether, sums.n_bins());
    double mean = 0.0;
    for (int bin = first; bin < last; ++bin) mean += power_of(sums, channel, bin) / (last - first);
    for (int bin = first; bin < last && mean > noise; ++bin) {
      const double w = core::kTwoPi * bin * sums.rate_hz / sums.n_fft;
      out[static_cast<std::size_t>(bin)] = power_of(sums, channel, bin) * std::pow(w, 2.0 * (1 - n_integrations));
    }
  }
  return out;
}

}  // namespace

double moves_up_to_hz(const core::CpsdSums& sums, const std::vector<core::ChannelInfo>& channels) {
  int last = 0;
  for (int c = 0; c < sums.n_channels && c < static_cast<int>(channels.size()); ++c) {
    const std::vector<double> power = motion_of(sums, c, channels[static_cast<std::size_t>(c)].n_integrations);
    const double whole = std::accumulate(power.begin(), power.end(), 0.0);
    double so_far = 0.0;
    for (int bin = kFirstBin; bin < sums.n_bins() && so_far < kShare * whole; ++bin) {
      so_far += power[static_cast<std::size_t>(bin)];
      last = std::max(last, bin);
    }
  }
  return last * sums.rate_hz / sums.n_fft;
}

std::string remark_on_oversampling(const core::CpsdSums& sums, const std::vector<core::ChannelInfo>& channels) {
  const double limit_hz = moves_up_to_hz(sums, channels);
  if (!(limit_hz > 0.0) || core::decimation_factor(sums.rate_hz, kMargin * limit_hz) < kLeastFactor) return {};
  return fmt::format(
      "99 % of the motion (power of the velocity) lies below {:.3g} Hz, far below half the rate of {:g} Hz: the "
      "window "
      "is short for such modes; identify with --max-frequency {:.3g} as well",
      limit_hz, sums.rate_hz, kMargin * limit_hz);
}

}  // namespace app
