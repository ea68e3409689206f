#include "rt/latency_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace rt {
namespace {

TEST(LatencyHistogram, IsAllZeroBeforeAnythingWasAdded) {
  const LatencyHistogram histogram;
  const auto p = histogram.percentiles();
  EXPECT_EQ(p.n, 0U);
  EXPECT_EQ(p.p50_ns, 0U);
  EXPECT_EQ(p.p999_ns, 0U);
  EXPECT_EQ(p.max_ns, 0U);
}

TEST(LatencyHistogram, HoldsShortDurationsExactly) {
  LatencyHistogram histogram;
  for (int ns = 1; ns <= 10; ++ns) histogram.add(ns);
  const auto p = histogram.percentiles();
  EXPECT_EQ(p.n, 10U);
  EXPECT_EQ(p.p50_ns, 5U);
  EXPECT_EQ(p.p99_ns, 10U);
  EXPECT_EQ(p.max_ns, 10U);
}

TEST(LatencyHistogram, PercentilesAreNeverTooShortAndAtMostASixteenthTooLong) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 random(seed);
    std::lognormal_distribution<double> draw(12.0, 3.0);
    LatencyHistogram histogram;
    std::vector<std::uint64_t> all;
    for (int i = 0; i < 20'000; ++i) {
      const auto ns = static_cast<std::int64_t>(std::min(draw(random), 1e12));
      histogram.add(ns);
      all.push_back(static_cast<std::uint64_t>(ns));
    }
    std::sort(all.begin(), all.end());
    const auto p = histogram.percentiles();
    const auto expect_near = [&](std::uint64_t told, double share) {
      const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(all.size())));
      const std::uint64_t exact = all[rank - 1];
      EXPECT_GE(told, exact) << share;
      EXPECT_LE(static_cast<double>(told), static_cast<double>(exact) * (1.0 + 1.0 / 16.0)) << share;
    };
    expect_near(p.p50_ns, 0.5);
    expect_near(p.p99_ns, 0.99);
    expect_near(p.p999_ns, 0.999);
    EXPECT_EQ(p.max_ns, all.back());
  }
}

TEST(LatencyHistogram, TakesNegativeAndEndlessDurations) {
  LatencyHistogram histogram;
  histogram.add(-5);
  histogram.add(INT64_MAX);
  const auto p = histogram.percentiles();
  EXPECT_EQ(p.n, 2U);
  EXPECT_EQ(p.p50_ns, 0U);
  EXPECT_EQ(p.p99_ns, static_cast<std::uint64_t>(INT64_MAX));
}

}  // namespace
}  // namespace rt
