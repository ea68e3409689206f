#include "core/compare/comparison_spectrum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/spectrum/welch_cpsd.h"

namespace core {
namespace {

constexpr int kSegmentsWanted = 12;  // a record's length is 6.5 segments, which overlap by half
constexpr double kCommonShare = 0.5, kChanceLevel = 1e-4;

}  // namespace

std::vector<ComparedBin> compared_spectrum(const BandLimited& camera, const BandLimited& sensor,
                                           const ClockAlignment& alignment, const Band& band, double camera_rate_hz,
                                           int& n_averages) {
  const auto first = static_cast<std::int64_t>(std::ceil(alignment.from_s * camera_rate_hz));
  const auto last = static_cast<std::int64_t>(std::floor(alignment.to_s * camera_rate_hz));
  WelchConfig config;
  config.n_channels = 2;
  config.n_blocks = 0;
  config.rate_hz = camera_rate_hz;
  config.segment = std::max(16, static_cast<int>((last - first) * 2 / (kSegmentsWanted + 1)));
  WelchCpsd welch(config);
  for (std::int64_t k = first; k <= last; ++k) {
    const double t_s = static_cast<double>(k) / camera_rate_hz;
    const bool seen = counts(camera, sensor, band, alignment.clock, t_s);
    const std::array<double, 2> value{seen ? camera.at(t_s) : 0.0,
                                      seen ? sensor.at(alignment.clock.sensor_s(t_s)) : 0.0};
    const auto mask = static_cast<std::uint8_t>(seen ? 1 : 0);
    (void)welch.push(value, std::array<std::uint8_t, 2>{mask, mask});
  }
  const CpsdSums& sums = welch.sums();
  n_averages = static_cast<int>(sums.n_segments);
  std::vector<ComparedBin> out;
  const double divisor = camera_rate_hz * sums.window_power * sums.weight.sum;
  for (int k = 1; k < sums.n_bins() && divisor > 0.0; ++k) {
    const double f_hz = k * camera_rate_hz / sums.n_fft;
    if (f_hz < band.low_hz || f_hz > band.high_hz) continue;
    const auto at = [&](int i, int j) {
      return sums.data_sum[3 * static_cast<std::size_t>(k) + static_cast<std::size_t>(CpsdSums::pair_index(i, j, 2))];
    };
    const double a = at(0, 0).real(), b = at(1, 1).real();
    out.push_back(
        {f_hz, 2.0 * a / divisor, 2.0 * b / divisor, a > 0.0 && b > 0.0 ? std::norm(at(0, 1)) / (a * b) : 0.0});
  }
  return out;
}

std::optional<Band> coherent_band(const std::vector<ComparedBin>& spectrum, const Band& searched, int n_averages) {
  if (spectrum.size() < 3 || n_averages < 3) return std::nullopt;
  // Segments that overlap by half count as three quarters (Welch 1967, Hann window).
  const double by_chance = 1.0 - std::pow(kChanceLevel, 1.0 / std::max(1.0, 0.75 * n_averages - 1.0));
  const auto is_common = [&](const ComparedBin& bin) { return bin.coherence > std::max(kCommonShare, by_chance); };
  const auto low = std::find_if(spectrum.begin(), spectrum.end(), is_common);
  const auto high = std::find_if(spectrum.rbegin(), spectrum.rend(), is_common);
  if (low == spectrum.end()) return std::nullopt;
  const double step_hz = spectrum[1].frequency_hz - spectrum[0].frequency_hz;
  return Band{std::max(searched.low_hz, low->frequency_hz - 2.0 * step_hz),
              std::min(searched.high_hz, high->frequency_hz + 2.0 * step_hz)};
}

double band_coherence(const std::vector<ComparedBin>& spectrum, const Band& band) {
  double sum = 0.0, weight = 0.0;
  for (const ComparedBin& bin : spectrum) {
    if (bin.frequency_hz < band.low_hz || bin.frequency_hz > band.high_hz) continue;
    sum += bin.camera * bin.coherence, weight += bin.camera;
  }
  return weight > 0.0 ? sum / weight : 0.0;
}

}  // namespace core
