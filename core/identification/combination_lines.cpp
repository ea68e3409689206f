#include "core/identification/combination_lines.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "core/identification/spectral_peaks.h"

namespace core {

namespace {

constexpr int kMostMultiple = 9;
constexpr double kExact = 0.05;              // tolerance, as a share of the resolution
constexpr double kStronger = 10.0;           // power ratio of a line to its combination, at least
constexpr double kMostHarmonicShare = 1e-3;  // share of the stronger line's power

// Power of all channels at a frequency: the largest of three bins.
double power_at(const CpsdSums& sums, const std::vector<ChannelInfo>& channels, double hz) {
  const int middle = static_cast<int>(std::lround(hz / sums.rate_hz * sums.n_fft));
  double most = 0.0;
  for (int k = std::max(0, middle - 1); k <= std::min(sums.n_bins() - 1, middle + 1); ++k) {
    double power = 0.0;
    for (int c = 0; c < sums.n_channels; ++c) {
      if (channels[static_cast<std::size_t>(c)].is_witness) continue;
      const auto at = static_cast<std::size_t>(k) * static_cast<std::size_t>(sums.n_pairs());
      power += sums.data_sum[at + static_cast<std::size_t>(CpsdSums::pair_index(c, c, sums.n_channels))].real();
    }
    most = std::max(most, power);
  }
  return most;
}

std::string words_of(int multiple, double hz, double rate_hz) {
  const double product = multiple * hz;
  const int n = static_cast<int>(std::lround(product / rate_hz));
  char buffer[120];
  if (n == 0)
    std::snprintf(buffer, sizeof buffer, "%d x %.4g Hz of a stronger line", multiple, hz);
  else
    std::snprintf(buffer, sizeof buffer, "%d x %.4g Hz of a stronger line, folded at %d x %.4g Hz", multiple, hz, n,
                  rate_hz);
  return buffer;
}

bool is_called_mode(const Mode& mode) noexcept {
  return mode.verdict == Verdict::kStructural || mode.verdict == Verdict::kAmbiguous ||
         mode.verdict == Verdict::kCandidate;
}

}  // namespace

void reject_combinations(const CpsdSums& sums, const std::vector<ChannelInfo>& channels, std::vector<Mode>& modes) {
  std::vector<double> power;
  for (const Mode& mode : modes) power.push_back(power_at(sums, channels, mode.apparent_hz));
  const double tolerance_hz = kExact * resolution_hz(sums);
  for (std::size_t b = 0; b < modes.size(); ++b) {
    for (std::size_t a = 0; a < modes.size() && is_called_mode(modes[b]); ++a) {
      if (a == b || !(power[a] > kStronger * power[b]) || modes[a].verdict == Verdict::kNumerical) continue;
      for (int k = 2; k <= kMostMultiple; ++k) {
        const double product = k * modes[a].frequency_hz;
        const double folded = std::abs(product - sums.rate_hz * std::round(product / sums.rate_hz));
        if (std::abs(folded - modes[b].apparent_hz) > tolerance_hz) continue;
        const std::string words = words_of(k, modes[a].frequency_hz, sums.rate_hz);
        if (power[b] < kMostHarmonicShare * power[a]) {
          modes[b].verdict = Verdict::kHarmonic;
          modes[b].reason = words + ", with less than a thousandth of its power";
        } else {
          modes[b].reason += "; exactly " + words;
        }
        break;
      }
    }
  }
}

}  // namespace core
