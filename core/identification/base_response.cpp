#include "core/identification/base_response.h"

#include <algorithm>
#include <cmath>

namespace core {

namespace {

constexpr double kSideStep = 0.1;  // relative

class BaseSpectra {
 public:
  BaseSpectra(const CpsdSums& sums, const std::vector<ChannelInfo>& channels, int base)
      : sums_(sums), channels_(channels), base_(base) {}

  // Mean over three bins, because a Hann window spreads a line over three.
  [[nodiscard]] double gain(double frequency_hz) const {
    const double position = frequency_hz * sums_.n_fft / sums_.rate_hz;
    const int centre = std::clamp(static_cast<int>(std::lround(position)), 1, sums_.n_bins() - 2);
    double largest = 0.0;
    for (int r = 0; r < sums_.n_channels; ++r) {
      if (channels_[static_cast<std::size_t>(r)].is_base || channels_[static_cast<std::size_t>(r)].is_witness) continue;
      std::complex<double> cross = 0.0;
      double power = 0.0;
      for (int k = centre - 1; k <= centre + 1; ++k) {
        cross += at(k, std::min(r, base_), std::max(r, base_));
        power += at(k, base_, base_).real();
      }
      if (power > 0.0) largest = std::max(largest, std::abs(cross) / power);
    }
    return largest;
  }

 private:
  [[nodiscard]] std::complex<double> at(int bin, int i, int j) const {
    return sums_.data_sum[static_cast<std::size_t>(bin) * static_cast<std::size_t>(sums_.n_pairs()) +
                          static_cast<std::size_t>(CpsdSums::pair_index(i, j, sums_.n_channels))];
  }

  const CpsdSums& sums_;
  const std::vector<ChannelInfo>& channels_;
  int base_;
};

}  // namespace

BaseResponse base_response(const CpsdSums& sums, const std::vector<ChannelInfo>& channels, double frequency_hz) {
  const auto base = std::find_if(channels.begin(), channels.end(), [](const ChannelInfo& c) { return c.is_base; });
  if (base == channels.end()) return {};
  const BaseSpectra spectra(sums, channels, static_cast<int>(base - channels.begin()));
  return {spectra.gain(frequency_hz),
          std::max(spectra.gain(frequency_hz * (1.0 - kSideStep)), spectra.gain(frequency_hz * (1.0 + kSideStep)))};
}

}  // namespace core
