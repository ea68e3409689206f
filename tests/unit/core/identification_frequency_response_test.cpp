#include "core/identification/frequency_response.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/spectrum/welch_cpsd.h"

namespace core {
namespace {

constexpr double kRate = 60.0;

// Channel 0: white input; channel 1: input plus resonators at 4 and 11 Hz (2 % damping); channel 2: its own noise.
CpsdSums driven(double noise, int n = 40000) {
  WelchConfig config;
  config.n_channels = 3;
  config.segment = 2048;
  config.rate_hz = kRate;
  WelchCpsd welch(config);
  std::mt19937 random(7);
  std::normal_distribution<double> gaussian;
  struct Resonator {
    double f, y1 = 0.0, y2 = 0.0;
    double step(double x) {
      const double w = 2.0 * std::numbers::pi * f / kRate;
      const double r = std::exp(-0.02 * w);
      const double y = (1.0 - r) * 2.0 * x + 2.0 * r * std::cos(w) * y1 - r * r * y2;
      y2 = y1;
      y1 = y;
      return y;
    }
  } first{4.0}, second{11.0};
  const std::vector<std::uint8_t> seen(3, 1);
  for (int t = 0; t < n; ++t) {
    const double x = gaussian(random);
    const std::vector<double> value{x, x + 4.0 * first.step(x) + 4.0 * second.step(x) + noise * gaussian(random),
                                    0.01 * gaussian(random)};
    (void)welch.push(value, seen);
  }
  welch.flush();
  return welch.sums();
}

TEST(ResponsePeaks, AreTheResonancesWithChannelAndCoherence) {
  const std::vector<ResponsePeak> peaks = response_peaks(driven(0.1), 0, 28.0);
  ASSERT_EQ(peaks.size(), 2U);
  EXPECT_NEAR(peaks[0].frequency_hz, 4.0, 0.04);
  EXPECT_NEAR(peaks[1].frequency_hz, 11.0, 0.11);
  for (const ResponsePeak& peak : peaks) {
    EXPECT_EQ(peak.channel, 1);
    EXPECT_GT(peak.gain, 3.0);
    EXPECT_GT(peak.coherence, 0.8);
    EXPECT_LE(peak.coherence, 1.0 + 1e-12);
  }
}

TEST(ResponsePeaks, NoneAboveTheLimitAndNoneOfNoise) {
  EXPECT_EQ(response_peaks(driven(0.1), 0, 8.0).size(), 1U);
  EXPECT_TRUE(response_peaks(driven(100.0), 0, 28.0).empty());
}

TEST(ResponsePeaks, NothingWithoutData) {
  WelchConfig config;
  config.n_channels = 3;
  EXPECT_TRUE(response_peaks(WelchCpsd::empty_sums(config), 0, 0.4).empty());
  EXPECT_TRUE(response_peaks(driven(0.1, 0), 0, 28.0).empty());
}

}  // namespace
}  // namespace core
