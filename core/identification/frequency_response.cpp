#include "core/identification/frequency_response.h"

#include <algorithm>
#include <cmath>

namespace core {

namespace {

constexpr double kLeastGain = 3.0;
constexpr double kLeastProminence = 2.0;
constexpr double kLeastCoherence = 0.5;

// Averages neighbouring bins: spectra are zero-padded to twice the segment, so that a bin is half a resolution wide.
class Response {
 public:
  Response(const CpsdSums& sums, int input) : sums_(sums), input_(input) {}

  [[nodiscard]] ResponsePeak at(int bin) const {
    ResponsePeak largest;
    for (int r = 0; r < sums_.n_channels; ++r) {
      if (r == input_) continue;
      std::complex<double> cross = 0.0;
      double in = 0.0;
      double out = 0.0;
      for (int k = bin - 1; k <= bin + 1; ++k) {
        cross += value(k, r, input_);
        in += value(k, input_, input_).real();
        out += value(k, r, r).real();
      }
      if (!(in > 0.0 && out > 0.0)) continue;
      const double gain = std::abs(cross) / in;
      if (gain > largest.gain) largest = {0.0, gain, r, std::norm(cross) / (in * out)};
    }
    return largest;
  }

 private:
  [[nodiscard]] std::complex<double> value(int bin, int i, int j) const {
    return sums_
        .data_sum[static_cast<std::size_t>(bin) * static_cast<std::size_t>(sums_.n_pairs()) +
                  static_cast<std::size_t>(CpsdSums::pair_index(std::min(i, j), std::max(i, j), sums_.n_channels))];
  }

  const CpsdSums& sums_;
  int input_;
};

// Lowest gain between a maximum and the next higher one, in direction `step`.
double valley(const std::vector<ResponsePeak>& response, std::size_t peak, int step) {
  double lowest = response[peak].gain;
  for (std::size_t k = peak; k > 0 && k + 1 < response.size();) {
    k = step > 0 ? k + 1 : k - 1;
    if (response[k].gain > response[peak].gain) break;
    lowest = std::min(lowest, response[k].gain);
  }
  return lowest;
}

double between_bins(double left, double centre, double right) {
  const double a = std::log(left);
  const double b = std::log(centre);
  const double c = std::log(right);
  const double curvature = a - 2.0 * b + c;
  return curvature < 0.0 ? std::clamp(0.5 * (a - c) / curvature, -0.5, 0.5) : 0.0;
}

}  // namespace

std::vector<ResponsePeak> response_peaks(const CpsdSums& sums, int input, double max_frequency_hz) {
  std::vector<ResponsePeak> peaks;
  if (sums.n_segments == 0 || sums.n_channels < 2 || sums.n_bins() < 8) return peaks;
  const double bin_hz = sums.rate_hz / sums.n_fft;
  const int last = std::min(sums.n_bins() - 2, static_cast<int>(max_frequency_hz / bin_hz));
  const Response spectra(sums, input);
  std::vector<ResponsePeak> response;
  for (int k = 1; k <= last; ++k) response.push_back(spectra.at(k));
  for (std::size_t i = 1; i + 1 < response.size(); ++i) {
    ResponsePeak peak = response[i];
    const double left = response[i - 1].gain;
    const double right = response[i + 1].gain;
    if (!(left > 0.0 && right > 0.0 && peak.gain >= left && peak.gain > right)) continue;
    if (peak.gain < kLeastGain || peak.coherence < kLeastCoherence) continue;
    if (peak.gain < kLeastProminence * std::max(valley(response, i, -1), valley(response, i, 1))) continue;
    peak.frequency_hz = (static_cast<double>(i + 1) + between_bins(left, peak.gain, right)) * bin_hz;
    peaks.push_back(peak);
  }
  return peaks;
}

}  // namespace core
