#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include "core/identification/identifier.h"
#include "core/spectrum/welch_cpsd.h"

namespace core {
namespace {

constexpr double kRateHz = 25.0;

WelchConfig config_of(double forget_s) {
  WelchConfig config;
  config.n_channels = 2;
  config.segment = 64;
  config.rate_hz = kRateHz;
  config.forget_s = forget_s;
  return config;
}

void push_noise(WelchCpsd& welch, int n, unsigned seed, double sigma = 1.0) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gaussian(0.0, sigma);
  const std::vector<std::uint8_t> seen(2, 1);
  for (int t = 0; t < n; ++t) welch.push(std::vector<double>{gaussian(random), gaussian(random)}, seen);
}

// Two segments: the first counts exp(-hop / forget).
TEST(WelchForgetting, OlderSegmentsCountExponentiallyLess) {
  const double hop_s = 32 / kRateHz, forget_s = 3.0;
  WelchCpsd forgets(config_of(forget_s)), remembers(config_of(0.0));
  push_noise(forgets, 64, 1);
  push_noise(remembers, 64, 1);
  const std::vector<std::complex<double>> first = remembers.sums().data_sum;
  push_noise(forgets, 32, 2);
  push_noise(remembers, 32, 2);
  const double kept = std::exp(-hop_s / forget_s);
  for (std::size_t k = 0; k < first.size(); ++k) {
    const std::complex<double> second = remembers.sums().data_sum[k] - first[k];
    EXPECT_NEAR(std::abs(forgets.sums().data_sum[k] - (kept * first[k] + second)), 0.0, 1e-9);
  }
  EXPECT_NEAR(forgets.sums().weight.sum, 1.0 + kept, 1e-12);
  EXPECT_NEAR(forgets.sums().weight.squares, 1.0 + kept * kept, 1e-12);
}

// As long as the memory: half of 2 forget_s / hop segments, (1 - k^2) / (1 - k)^2 of them effective.
TEST(WelchForgetting, RemembersTwiceTheTimeConstant) {
  WelchCpsd welch(config_of(20.0));
  push_noise(welch, 20000, 3);
  EXPECT_NEAR(welch.sums().n_remembered() / kRateHz, 40.0, 1.5);
  EXPECT_EQ(welch.sums().n_samples, 20000U);
  WelchCpsd all(config_of(0.0));
  push_noise(all, 20000, 3);
  EXPECT_DOUBLE_EQ(all.sums().n_remembered(), 20000.0);
}

TEST(WelchForgetting, BlocksStillAddUpToTheSumsInAnyLengthOfRecord) {
  WelchCpsd welch(config_of(20.0));
  for (int part = 0; part < 12; ++part) {
    push_noise(welch, 1000, static_cast<unsigned>(part));
    const CpsdSums& sums = welch.sums();
    ASSERT_GE(sums.n_blocks, 10U);
    SegmentWeight weight;
    std::complex<double> total = 0.0;
    std::uint64_t n_segments = 0;
    for (std::size_t b = 0; b < sums.n_blocks; ++b) {
      weight.join(sums.blocks[b].weight);
      total += sums.blocks[b].data_sum[30];
      n_segments += sums.blocks[b].n_segments;
    }
    EXPECT_EQ(n_segments, sums.n_segments);
    EXPECT_NEAR(weight.sum, sums.weight.sum, 1e-9);
    EXPECT_NEAR(std::abs(total - sums.data_sum[30]), 0.0, 1e-9 * std::abs(sums.data_sum[30]));
  }
}

TEST(WelchForgetting, FollowsAStructureThatChanges) {
  const auto identified_hz = [](double forget_s) {
    WelchConfig config = config_of(forget_s);
    config.segment = 256;
    WelchCpsd welch(config);
    std::mt19937 random(5);
    std::normal_distribution<double> gaussian;
    std::array<double, 2> x{};
    for (int t = 0; t < 30000; ++t) {
      const double frequency_hz = t < 15000 ? 3.0 : 2.5;
      const double turn = 2.0 * std::numbers::pi * frequency_hz / kRateHz, decay = std::exp(-0.01 * turn);
      const double now = 2.0 * decay * std::cos(turn) * x[0] - decay * decay * x[1] + gaussian(random);
      x = {now, x[0]};
      welch.push(std::vector<double>{now + 0.1 * gaussian(random), 0.5 * now + 0.1 * gaussian(random)},
                 std::vector<std::uint8_t>{1, 1});
    }
    const ModalEstimate estimate = Identifier({}, std::vector<ChannelInfo>(2)).identify(welch.sums());
    EXPECT_EQ(estimate.status, "ok");
    std::vector<double> found;
    for (const Mode& mode : estimate.modes) found.push_back(mode.frequency_hz);
    return found;
  };
  const std::vector<double> now = identified_hz(60.0);
  ASSERT_EQ(now.size(), 1U);
  EXPECT_NEAR(now[0], 2.5, 0.02);
  const std::vector<double> ever = identified_hz(0.0);
  EXPECT_TRUE(std::any_of(ever.begin(), ever.end(), [](double f) { return std::abs(f - 3.0) < 0.05; }));
}

TEST(WelchForgetting, RefusesATimeThatIsNone) {
  for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(WelchCpsd{config_of(bad)}, std::invalid_argument) << bad;
  }
}

}  // namespace
}  // namespace core
