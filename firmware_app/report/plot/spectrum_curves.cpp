#include "firmware_app/report/plot/spectrum_curves.h"

#include <cmath>
#include <limits>

namespace app {
namespace {

std::complex<double> at(const core::CpsdSums& sums, int bin, int pair) {
  return sums.data_sum[static_cast<std::size_t>(bin) * static_cast<std::size_t>(sums.n_pairs()) +
                       static_cast<std::size_t>(pair)];
}

// value(bin) is computed from the undivided sums.
template <class Value>
std::vector<PlotPoint> one_sided(const core::CpsdSums& sums, const Value& value) {
  std::vector<PlotPoint> out;
  for (int k = 1; k < sums.n_bins(); ++k) {
    const double y = value(k) / density_divisor(sums, k);
    out.push_back({k * sums.rate_hz / sums.n_fft, y > 0.0 ? y : std::numeric_limits<double>::quiet_NaN()});
  }
  return out;
}

}  // namespace

double density_divisor(const core::CpsdSums& sums, int bin) noexcept {
  const double sides = 2 * bin == sums.n_fft ? 1.0 : 2.0;
  return sums.rate_hz * sums.window_power * sums.weight.sum / sides;
}

bool is_drawable(const core::CpsdSums* sums) noexcept {
  if (sums == nullptr || sums->n_channels < 1 || sums->n_fft < 4 || sums->n_segments == 0) return false;
  const auto n_values = static_cast<std::size_t>(sums->n_bins()) * static_cast<std::size_t>(sums->n_pairs());
  return sums->data_sum.size() == n_values && sums->rate_hz > 0.0 && sums->window_power > 0.0;
}

std::vector<PlotPoint> density(const core::CpsdSums& sums, int channel) {
  const int pair = core::CpsdSums::pair_index(channel, channel, sums.n_channels);
  return one_sided(sums, [&](int k) { return at(sums, k, pair).real(); });
}

std::vector<PlotPoint> cross_density(const core::CpsdSums& sums, int i, int j) {
  const int pair = core::CpsdSums::pair_index(i, j, sums.n_channels);
  return one_sided(sums, [&](int k) { return std::abs(at(sums, k, pair)); });
}

std::vector<PlotPoint> total_density(const core::CpsdSums& sums) {
  return one_sided(sums, [&](int k) {
    double total = 0.0;
    for (int c = 0; c < sums.n_channels; ++c) {
      const double value = at(sums, k, core::CpsdSums::pair_index(c, c, sums.n_channels)).real();
      if (std::isfinite(value)) total += value;
    }
    return total;
  });
}

std::optional<std::pair<int, int>> strongest_pair(const core::CpsdSums& sums,
                                                  const std::vector<core::ChannelInfo>& channels) {
  const auto is_base = [&](int c) {
    return static_cast<std::size_t>(c) < channels.size() && channels[static_cast<std::size_t>(c)].is_base;
  };
  std::optional<std::pair<int, int>> best;
  double most = 0.0;
  for (int i = 0; i < sums.n_channels; ++i) {
    for (int j = i + 1; j < sums.n_channels; ++j) {
      if (is_base(i) || is_base(j)) continue;
      double shared = 0.0;
      const int pair = core::CpsdSums::pair_index(i, j, sums.n_channels);
      for (int k = 1; k < sums.n_bins(); ++k) shared += std::abs(at(sums, k, pair));
      if (shared > most) most = shared, best = {i, j};
    }
  }
  return best;
}

}  // namespace app
