#include "core/spectrum/bridge_losses.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace core {
namespace {

struct Bridged {
  std::vector<double> y;
  std::vector<std::uint8_t> held;
};

Bridged bridged(const std::vector<double>& x, const std::vector<std::uint8_t>& seen) {
  Bridged out{std::vector<double>(x.size()), std::vector<std::uint8_t>(x.size())};
  bridge_losses(x, seen, out.y, out.held);
  return out;
}

TEST(BridgeLosses, LeavesACompleteRecordAlone) {
  const std::vector<double> x{3.0, -1.0, 4.0, 1.5, 9.0};
  const Bridged out = bridged(x, {1, 1, 1, 1, 1});
  EXPECT_EQ(out.y, x);
  EXPECT_EQ(out.held, std::vector<std::uint8_t>(5, 1));
}

TEST(BridgeLosses, FollowsALineThroughEveryShortGap) {
  std::vector<double> x;
  for (int t = 0; t < 20; ++t) x.push_back(2.0 + 0.5 * t);
  std::vector<std::uint8_t> seen(20, 1);
  std::vector<double> lossy = x;
  for (const std::size_t t : {3U, 7U, 8U, 12U, 13U, 14U, 15U, 16U}) seen[t] = 0, lossy[t] = 0.0;
  const Bridged out = bridged(lossy, seen);
  for (std::size_t t = 0; t < 20; ++t) {
    EXPECT_NEAR(out.y[t], x[t], 1e-12) << t;
    EXPECT_EQ(out.held[t], 1) << t;
  }
}

TEST(BridgeLosses, LongGapsAndEndsStayMissing) {
  constexpr std::size_t kSamples = kLongestBridge + 20;
  std::vector<double> x(kSamples, 1.0);
  std::vector<std::uint8_t> seen(kSamples, 1);
  for (std::size_t t = 5; t < 5 + kLongestBridge + 1; ++t) seen[t] = 0, x[t] = 0.0;
  seen[0] = seen[kSamples - 1] = 0;
  const Bridged out = bridged(x, seen);
  for (std::size_t t = 0; t < kSamples; ++t) EXPECT_EQ(out.held[t], seen[t]) << t;
}

// A slow motion with a gap in which it turns.
TEST(BridgeLosses, TheLongestGapFollowsSlowMotion) {
  std::vector<double> x;
  for (int t = 0; t < 512; ++t) x.push_back(20.0 * std::cos(0.05 * t));
  std::vector<std::uint8_t> seen(512, 1);
  std::vector<double> lossy = x;
  for (std::size_t t = 240; t < 240 + kLongestBridge; ++t) seen[t] = 0, lossy[t] = 0.0;
  const Bridged out = bridged(lossy, seen);
  for (std::size_t t = 0; t < 512; ++t) {
    EXPECT_NEAR(out.y[t], x[t], 0.2) << t;
    EXPECT_EQ(out.held[t], 1) << t;
  }
}

TEST(BridgeLosses, AnythingMayBeMissing) {
  for (const std::vector<std::uint8_t>& seen :
       {std::vector<std::uint8_t>{}, {0}, {1}, {0, 0}, {1, 0}, {0, 1, 0}, {0, 0, 0, 0, 0, 0, 0, 0, 0}}) {
    const Bridged out = bridged(std::vector<double>(seen.size(), 2.0), seen);
    EXPECT_EQ(out.held, seen);
  }
}

// The same signal with many draws of the losses: its mean is the signal, its scatter far below that of zeros.
TEST(BridgeLosses, HasTheSignalAsItsExpectationAtEveryFrequency) {
  constexpr std::size_t kSamples = 64;
  constexpr int kDraws = 2000;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit;
  for (const double w : {0.1, 0.8, 2.9}) {
    std::vector<double> x, mean(kSamples, 0.0);
    for (std::size_t t = 0; t < kSamples; ++t) x.push_back(std::cos(w * static_cast<double>(t)));
    double squares = 0.0;
    for (int draw = 0; draw < kDraws; ++draw) {
      std::vector<double> lossy = x;
      std::vector<std::uint8_t> seen(kSamples, 1);
      for (std::size_t t = 0; t < kSamples; ++t) {
        if (unit(random) < 0.1) seen[t] = 0, lossy[t] = 0.0;
      }
      const Bridged out = bridged(lossy, seen);
      for (std::size_t t = 8; t < kSamples - 8; ++t) {
        mean[t] += out.y[t] / kDraws;
        squares += (out.y[t] - x[t]) * (out.y[t] - x[t]) / (kDraws * (kSamples - 16.0));
      }
    }
    for (std::size_t t = 8; t < kSamples - 8; ++t) EXPECT_NEAR(mean[t], x[t], 0.025) << w << " at " << t;
    const double rest = 1.0 - std::cos(w);  // the part of the signal not represented by a line through both neighbours
    // Lost neighbours lengthen the line up to twofold.
    EXPECT_LT(squares, 2.0 * 0.1 / 0.9 * 0.5 * rest * rest + 1e-4) << w;
  }
}

}  // namespace
}  // namespace core
