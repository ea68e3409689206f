#include "core/spectrum/decimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace core {
namespace {

std::vector<double> sine(double frequency_hz, double rate_hz, int n, double phase = 0.3) {
  std::vector<double> x(static_cast<std::size_t>(n));
  for (std::size_t t = 0; t < x.size(); ++t)
    x[t] = std::sin(2.0 * std::numbers::pi * frequency_hz * static_cast<double>(t) / rate_hz + phase);
  return x;
}

// Largest value of a record away from its ends.
double largest_inside(const std::vector<double>& x, std::size_t margin) {
  double largest = 0.0;
  for (std::size_t t = margin; t + margin < x.size(); ++t) largest = std::max(largest, std::abs(x[t]));
  return largest;
}

TEST(Decimator, KeepsThePassbandInPlaceWithoutDelay) {
  for (const int factor : {2, 3, 8, 25}) {
    const double rate_hz = 100.0;
    for (const double share : {0.0, 0.1, 0.25, 0.4}) {
      const double f = share * rate_hz / factor;
      const std::vector<double> out = Decimator(factor).decimate(sine(f, rate_hz, 200 * factor));
      const std::vector<double> wanted = sine(f, rate_hz / factor, 200);
      ASSERT_EQ(out.size(), wanted.size());
      for (std::size_t t = 20; t + 20 < out.size(); ++t) EXPECT_NEAR(out[t], wanted[t], 2e-4) << factor << " " << share;
    }
  }
}

TEST(Decimator, StopsWhatWouldFoldIntoThePassband) {
  for (const int factor : {2, 3, 8, 25}) {
    for (const double share : {0.6, 0.75, 0.99, 1.3, 0.49 * factor}) {
      if (share < 0.6 || share > 0.5 * factor) continue;
      const std::vector<double> out = Decimator(factor).decimate(sine(share / factor, 1.0, 200 * factor));
      EXPECT_LT(largest_inside(out, 20), 2e-4) << factor << " " << share;
    }
  }
}

TEST(Decimator, AConstantStaysExactAlsoBesideAGap) {
  std::vector<double> x(4000, 7.25);
  for (std::size_t t = 2000; t < 2040; ++t) x[t] = std::numeric_limits<double>::quiet_NaN();
  int n_seen = 0;
  for (const double value : Decimator(8).decimate(x)) {
    if (!std::isfinite(value)) continue;
    EXPECT_NEAR(value, 7.25, 1e-12);
    ++n_seen;
  }
  EXPECT_GT(n_seen, 450);
}

TEST(Decimator, AGapMasksItsNeighbourhoodAndNoMore) {
  std::vector<double> x = sine(1.0, 100.0, 4000);
  for (std::size_t t = 2000; t < 2080; ++t) x[t] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> out = Decimator(10).decimate(x);
  const std::vector<double> wanted = sine(1.0, 10.0, 400);
  int n_missing = 0;
  for (std::size_t t = 20; t + 20 < out.size(); ++t) {
    if (std::isnan(out[t])) {
      ++n_missing;
      EXPECT_NEAR(static_cast<double>(t), 204.0, 16.0);
    } else {
      EXPECT_NEAR(out[t], wanted[t], 0.03) << t;
    }
  }
  EXPECT_GE(n_missing, 8);
  EXPECT_LE(n_missing, 32);
}

TEST(Decimator, InfinitiesCountAsMissing) {
  std::vector<double> x(1000, 1.0);
  x[500] = std::numeric_limits<double>::infinity();
  for (const double value : Decimator(5).decimate(x)) EXPECT_FALSE(std::isinf(value));
}

TEST(Decimator, FactorOneCopies) {
  const std::vector<double> x = sine(3.0, 100.0, 50);
  EXPECT_EQ(Decimator(1).decimate(x), x);
}

TEST(Decimator, ShortAndEmptyRecordsHaveNothingToShow) {
  EXPECT_TRUE(Decimator(4).decimate({}).empty());
  const std::vector<double> three{1.0, 2.0, 3.0};
  const std::vector<double> out = Decimator(4).decimate(three);
  ASSERT_EQ(out.size(), 1U);
  EXPECT_TRUE(std::isnan(out.front()));
}

TEST(Decimator, RefusesFactorsThatAreNone) {
  EXPECT_THROW(Decimator(0), std::invalid_argument);
  EXPECT_THROW(Decimator(-2), std::invalid_argument);
  EXPECT_THROW(Decimator(1 << 20), std::invalid_argument);
}

TEST(DecimationFactor, PutsThePassbandJustAboveTheWantedFrequency) {
  EXPECT_EQ(decimation_factor(256.0, 12.0), 8);
  EXPECT_EQ(decimation_factor(256.0, 12.8), 8);
  EXPECT_EQ(decimation_factor(256.0, 12.81), 7);
  EXPECT_EQ(decimation_factor(25.0, 16.0), 1);
  EXPECT_EQ(decimation_factor(25.0, 0.0), 1);
  EXPECT_EQ(decimation_factor(25.0, std::numeric_limits<double>::quiet_NaN()), 1);
}

}  // namespace
}  // namespace core
