#include "core/spectrum/outlier_gate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "core/spectrum/welch_cpsd.h"

namespace core {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

// Indices of the samples rejected, the end of the record included.
std::vector<std::size_t> rejected(const std::vector<double>& x) {
  OutlierGate gate(1);
  std::vector<std::size_t> out;
  for (std::size_t t = 0; t < x.size(); ++t) {
    if (gate.push(0, x[t], std::isfinite(x[t]))) out.push_back(t - 1);
  }
  if (gate.push(0, 0.0, false)) out.push_back(x.size() - 1);
  return out;
}

// A vibration of amplitude 10 at a fifteenth of the rate, in noise.
std::vector<double> vibration(std::size_t n, double noise, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gauss(0.0, noise);
  std::vector<double> x(n);
  for (std::size_t t = 0; t < n; ++t) x[t] = 10.0 * std::sin(kTwoPi * static_cast<double>(t) / 15.0) + gauss(random);
  return x;
}

TEST(OutlierGate, FindsOneSampleOffAndNoOther) {
  for (const double off : {20.0, -100.0, 1e6}) {
    std::vector<double> x = vibration(400, 0.05);
    x[200] += off;
    EXPECT_EQ(rejected(x), std::vector<std::size_t>{200}) << off;
  }
}

TEST(OutlierGate, KeepsNoiseOfAnyColour) {
  std::mt19937 random(3);
  std::normal_distribution<double> gauss;
  std::vector<double> white(200'000), drift(200'000), narrow(200'000);
  double level = 0.0, a = 0.0, b = 0.0;
  for (std::size_t t = 0; t < white.size(); ++t) {
    white[t] = gauss(random);
    drift[t] = level += gauss(random);
    const double c = 1.8 * std::cos(kTwoPi * 0.11) * a - 0.81 * b + gauss(random);  // AR(2), 17 % of damping
    b = a, a = c, narrow[t] = c;
  }
  EXPECT_TRUE(rejected(white).empty());
  EXPECT_TRUE(rejected(drift).empty());
  EXPECT_TRUE(rejected(narrow).empty());
}

// x(t), from rest with little noise; the event is at t = 100.
std::vector<double> event(const std::function<double(double)>& after) {
  std::mt19937 random(5);
  std::normal_distribution<double> gauss(0.0, 0.02);
  std::vector<double> x(300);
  for (std::size_t t = 0; t < x.size(); ++t) {
    x[t] = gauss(random) + (t < 100 ? after(-1.0) : after(static_cast<double>(t) - 100.0));
  }
  return x;
}

TEST(OutlierGate, KeepsAReleaseUpToFourTenthsOfTheRate) {
  for (const double f : {0.02, 0.05, 0.1, 0.2, 0.25, 0.35, 0.4}) {
    const auto x =
        event([f](double t) { return t < 0.0 ? 10.0 : 10.0 * std::exp(-0.01 * t) * std::cos(kTwoPi * f * t); });
    EXPECT_TRUE(rejected(x).empty()) << f << " of the rate";
  }
}

TEST(OutlierGate, OfAnImpactAtMostOneSampleIsLost) {
  for (const double f : {0.02, 0.05, 0.1, 0.2, 0.25, 0.35, 0.45}) {
    const auto x =
        event([f](double t) { return t < 0.0 ? 0.0 : 10.0 * std::exp(-0.01 * t) * std::sin(kTwoPi * f * t); });
    EXPECT_LE(rejected(x).size(), 1U) << f << " of the rate";
  }
}

TEST(OutlierGate, KeepsAStep) {
  EXPECT_TRUE(rejected(event([](double t) { return t < 0.0 ? 0.0 : 10.0; })).empty());
}

TEST(OutlierGate, AChannelThatNeverMovesHasNoOutlier) {
  std::vector<double> x(300, 1.0);
  x[150] = 2.0;
  EXPECT_TRUE(rejected(x).empty()) << "a step of the last digit is the only motion there is";
}

TEST(OutlierGate, ASampleBeforeAGapIsJudgedByThePast) {
  std::vector<double> x = vibration(400, 0.05);
  x[200] += 50.0;
  x[201] = std::nan("");
  EXPECT_EQ(rejected(x), std::vector<std::size_t>{200});
}

TEST(OutlierGate, RepeatedOutliersAreFoundWhileTheyAreRare) {
  std::vector<double> x = vibration(3000, 0.05);
  std::vector<std::size_t> wanted;
  for (std::size_t t = 100; t < x.size(); t += 97) x[t] += 30.0, wanted.push_back(t);
  EXPECT_EQ(rejected(x), wanted);
}

WelchConfig welch_config(double overlap = 0.5) {
  WelchConfig config;
  config.gate_outliers = true;
  config.n_channels = 2, config.segment = 64, config.overlap = overlap, config.rate_hz = 10.0;
  return config;
}

// Sums of a record in which some samples are unseen.
CpsdSums sums_of(const std::vector<double>& x, const std::vector<double>& y, const WelchConfig& config) {
  WelchCpsd welch(config);
  for (std::size_t t = 0; t < x.size(); ++t) {
    const std::vector<double> value{x[t], y[t]};
    const std::vector<std::uint8_t> seen{static_cast<std::uint8_t>(std::isfinite(x[t])), 1};
    (void)welch.push(value, seen);
  }
  welch.flush();
  return welch.sums();
}

TEST(OutlierGate, SpectraWithAnOutlierAreThoseOfTheRecordWithoutTheSample) {
  for (const double overlap : {0.0, 0.5}) {
    // Also where a segment ends with the event: it is masked there before later samples confirm it.
    for (const std::size_t at : {200U, 191U, 255U, 256U}) {
      std::vector<double> x = vibration(400, 0.05), y = vibration(400, 0.05, 2), lost = x;
      x[at] += 30.0;
      lost[at] = std::nan("");
      WelchConfig ungated = welch_config(overlap);
      ungated.gate_outliers = false;
      const CpsdSums a = sums_of(x, y, welch_config(overlap)), b = sums_of(lost, y, ungated);
      EXPECT_EQ(a.data_sum, b.data_sum) << at << ", overlap " << overlap;
      EXPECT_EQ(a.mask_sum, b.mask_sum) << at;
      EXPECT_EQ(a.n_missing, b.n_missing);
      EXPECT_EQ(a.n_outlying, (std::vector<std::uint64_t>{1, 0}));
    }
  }
}

}  // namespace
}  // namespace core
