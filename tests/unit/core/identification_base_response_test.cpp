#include "core/identification/base_response.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/spectrum/welch_cpsd.h"

namespace core {
namespace {

// Spectra of floors that answer their base with gain |H| at each bin; the base has the power `base_power`.
template <class Gain, class Power>
CpsdSums spectra(int base_channel, Gain gain, Power base_power) {
  WelchConfig config;
  config.n_channels = 3;
  config.segment = 256;
  config.rate_hz = 25.6;  // bins of 0.05 Hz
  CpsdSums sums = WelchCpsd::empty_sums(config);
  sums.n_segments = 1;
  for (int k = 0; k < sums.n_bins(); ++k) {
    const double f = k * sums.rate_hz / sums.n_fft;
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) {
        const double gi = i == base_channel ? 1.0 : gain(f) * (i == 2 ? 0.5 : 1.0);
        const double gj = j == base_channel ? 1.0 : gain(f) * (j == 2 ? 0.5 : 1.0);
        sums.data_sum[static_cast<std::size_t>(k * sums.n_pairs() + CpsdSums::pair_index(i, j, 3))] =
            gi * gj * base_power(f);
      }
    }
  }
  return sums;
}

std::vector<ChannelInfo> channels(int base) {
  std::vector<ChannelInfo> list(3);
  if (base >= 0) list[static_cast<std::size_t>(base)].is_base = true;
  return list;
}

double resonance(double f) { return 1.0 + 9.0 / (1.0 + 400.0 * (f - 3.0) * (f - 3.0)); }
double flat(double) { return 1.0; }
double peak_at_5(double f) { return 1.0 + 500.0 / (1.0 + 400.0 * (f - 5.0) * (f - 5.0)); }

TEST(BaseResponse, AModeIsALocalMaximumWhereverTheBaseStandsInTheList) {
  for (const int base : {0, 1}) {
    const BaseResponse response = base_response(spectra(base, resonance, flat), channels(base), 3.0);
    EXPECT_GT(response.gain, 6.0);
    EXPECT_LT(response.gain_beside, 3.0);
  }
}

TEST(BaseResponse, APeakOfTheInputIsNone) {
  const BaseResponse response = base_response(spectra(0, flat, peak_at_5), channels(0), 5.0);
  EXPECT_NEAR(response.gain, 1.0, 1e-12);
  EXPECT_NEAR(response.gain_beside, 1.0, 1e-12);
}

TEST(BaseResponse, ASteadyInputIsKnownAndAShortOneIsNot) {
  CpsdSums sums = spectra(0, flat, flat);
  sums.blocks.clear(), sums.n_blocks = 10;
  for (std::size_t b = 0; b < sums.n_blocks; ++b)
    sums.blocks.push_back({.n_segments = 1, .weight = {}, .data_sum = sums.data_sum, .mask_sum = {}});
  EXPECT_TRUE(base_response(sums, channels(0), 6.0, 0.05).base_is_known);
  for (std::size_t b = 0; b < sums.n_blocks; ++b) {  // the power lies in four blocks of ten
    if (b % 5 > 1) std::fill(sums.blocks[b].data_sum.begin(), sums.blocks[b].data_sum.end(), 0.0);
  }
  EXPECT_FALSE(base_response(sums, channels(0), 6.0, 0.05).base_is_known);
}

TEST(BaseResponse, IsZeroWithoutABaseOrWithASilentOne) {
  EXPECT_EQ(base_response(spectra(0, resonance, flat), channels(-1), 3.0).gain, 0.0);
  EXPECT_EQ(base_response(spectra(0, resonance, [](double) { return 0.0; }), channels(0), 3.0).gain, 0.0);
}

TEST(BaseResponse, StaysInsideTheSpectrumAtItsEnds) {
  const CpsdSums sums = spectra(0, flat, flat);
  for (const double f : {0.0, 1e-6, 12.79, 12.8, 1000.0}) {
    const BaseResponse response = base_response(sums, channels(0), f);
    EXPECT_NEAR(response.gain, 1.0, 1e-12) << f;
    EXPECT_NEAR(response.gain_beside, 1.0, 1e-12) << f;
  }
}

}  // namespace
}  // namespace core
