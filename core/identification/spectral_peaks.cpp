#include "core/identification/spectral_peaks.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/linear/median.h"

namespace core {

namespace {

using Complex = std::complex<double>;

constexpr double kLeastHeight = 4.0;  // over the median of the bins on either side
// In bins of the zero-padded spectrum: the main lobe of a segment is eight bins wide.
constexpr int kHalfLobe = 4, kBeside = 40;
constexpr int kPowerSteps = 30;

struct Spectra {
  const CpsdSums& sums;
  std::vector<std::size_t> used;  // channels that are not witnesses
  std::vector<double> weight;     // of each channel's power: 1; if quantities differ, one over the channel's own power

  [[nodiscard]] Complex at(std::size_t i, std::size_t j, std::size_t bin) const {
    const bool mirrored = i > j;
    const auto pair = static_cast<std::size_t>(
        CpsdSums::pair_index(static_cast<int>(mirrored ? j : i), static_cast<int>(mirrored ? i : j), sums.n_channels));
    const Complex value = sums.data_sum[bin * static_cast<std::size_t>(sums.n_pairs()) + pair];
    return mirrored ? std::conj(value) : value;
  }
};

Spectra spectra_of(const CpsdSums& sums, const std::vector<ChannelInfo>& channels) {
  Spectra out{sums, {}, {}};
  bool alike = true;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c].is_witness) continue;
    out.used.push_back(c);
    alike = alike && channels[c].n_integrations == channels[out.used.front()].n_integrations;
  }
  for (const std::size_t c : out.used) {
    double power = 0.0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(sums.n_bins()) && !alike; ++k) power += out.at(c, c, k).real();
    out.weight.push_back(alike ? 1.0 : power > 0.0 ? 1.0 / power : 0.0);
  }
  return out;
}

std::vector<double> summed_power(const Spectra& spectra) {
  std::vector<double> out(static_cast<std::size_t>(spectra.sums.n_bins()), 0.0);
  for (std::size_t k = 0; k < out.size(); ++k) {
    for (std::size_t i = 0; i < spectra.used.size(); ++i)
      out[k] += spectra.weight[i] * spectra.at(spectra.used[i], spectra.used[i], k).real();
  }
  return out;
}

double median_beside(const std::vector<double>& power, int k) {
  std::vector<double> beside;
  for (int at = k - kBeside; at <= k + kBeside; ++at) {
    if (at > 0 && at < static_cast<int>(power.size()) && std::abs(at - k) > kHalfLobe)
      beside.push_back(power[static_cast<std::size_t>(at)]);
  }
  return beside.empty() ? 0.0 : median(std::move(beside));
}

bool is_highest_of_its_lobe(const std::vector<double>& power, int k) {
  for (int at = k - kHalfLobe; at <= k + kHalfLobe; ++at) {
    if (at >= 0 && at < static_cast<int>(power.size()) && at != k &&
        power[static_cast<std::size_t>(at)] >= power[static_cast<std::size_t>(k)])
      return false;
  }
  return true;
}

// Vertex of the parabola through the logarithms of three bins, in bins from the middle one.
double vertex(double before, double middle, double after) {
  if (!(before > 0.0 && middle > 0.0 && after > 0.0)) return 0.0;
  const double a = std::log(before), b = std::log(middle), c = std::log(after), bend = a - 2.0 * b + c;
  return bend < 0.0 ? std::clamp(0.5 * (a - c) / bend, -0.5, 0.5) : 0.0;
}

// Amplitudes of the first principal component, as displacements, per channel of the sums.
std::vector<double> shares_at(const Spectra& spectra, std::size_t bin, const std::vector<ChannelInfo>& channels,
                              double frequency_hz) {
  const std::size_t n = spectra.used.size();
  std::vector<Complex> x(n, 1.0), y(n);
  for (std::size_t i = 0; i < n; ++i)
    x[i] = std::sqrt(std::max(0.0, spectra.at(spectra.used[i], spectra.used[i], bin).real()));
  for (int step = 0; step < kPowerSteps; ++step) {
    double norm = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      y[i] = 0.0;
      for (std::size_t j = 0; j < n; ++j) y[i] += spectra.at(spectra.used[i], spectra.used[j], bin) * x[j];
      norm += std::norm(y[i]);
    }
    if (!(norm > 0.0) || !std::isfinite(norm)) break;
    for (std::size_t i = 0; i < n; ++i) x[i] = y[i] / std::sqrt(norm);
  }
  std::vector<double> out(channels.size(), 0.0);
  double largest = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const int k = channels[spectra.used[i]].n_integrations;
    const double share = std::abs(x[i]) / std::pow(2.0 * std::numbers::pi * frequency_hz, k);
    out[spectra.used[i]] = std::isfinite(share) ? share : 0.0;
    largest = std::max(largest, out[spectra.used[i]]);
  }
  for (double& share : out) share = largest > 0.0 ? share / largest : 0.0;
  return out;
}

}  // namespace

double resolution_hz(const CpsdSums& sums) noexcept {
  const double longest = std::min(0.5 * sums.n_fft, static_cast<double>(sums.n_samples));
  return longest > 0.0 ? sums.rate_hz / longest : 0.0;
}

std::vector<SpectralPeak> spectral_peaks(const CpsdSums& sums, const std::vector<ChannelInfo>& channels) {
  std::vector<SpectralPeak> peaks;
  if (sums.n_segments == 0 || sums.data_sum.empty()) return peaks;
  const Spectra spectra = spectra_of(sums, channels);
  const std::vector<double> power = summed_power(spectra);
  const double hz_per_bin = sums.rate_hz / sums.n_fft;
  for (int k = kHalfLobe; k + 1 < static_cast<int>(power.size()); ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (!std::isfinite(power[at]) || !is_highest_of_its_lobe(power, k)) continue;
    const double beside = median_beside(power, k);
    if (!(beside > 0.0) || power[at] < kLeastHeight * beside) continue;
    SpectralPeak peak;
    peak.frequency_hz = (k + vertex(power[at - 1], power[at], power[at + 1])) * hz_per_bin;
    peak.resolution_hz = resolution_hz(sums);
    peak.height = power[at] / beside;
    peaks.push_back(std::move(peak));
  }
  std::sort(peaks.begin(), peaks.end(), [](const auto& a, const auto& b) { return a.height > b.height; });
  if (peaks.size() > kMostPeaks) peaks.resize(kMostPeaks);
  std::sort(peaks.begin(), peaks.end(), [](const auto& a, const auto& b) { return a.frequency_hz < b.frequency_hz; });
  for (SpectralPeak& peak : peaks) {
    const auto bin = static_cast<std::size_t>(std::lround(peak.frequency_hz / hz_per_bin));
    peak.share = shares_at(spectra, bin, channels, peak.frequency_hz);
  }
  return peaks;
}

}  // namespace core
