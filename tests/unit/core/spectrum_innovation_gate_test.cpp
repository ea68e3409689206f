#include "core/spectrum/innovation_gate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "core/spectrum/welch_cpsd.h"

namespace core {
namespace {

constexpr std::size_t kChannels = 4;
using Record = std::vector<std::vector<double>>;              // by channel
using Found = std::set<std::pair<std::size_t, std::size_t>>;  // channel, sample

Found found_in(const Record& x) {
  InnovationGate gate(x.size());
  Found out;
  for (std::size_t t = 0; t < x.front().size(); ++t) {
    for (std::size_t c = 0; c < x.size(); ++c) gate.push(c, x[c][t], std::isfinite(x[c][t]), false);
    gate.settle();
    for (std::size_t c = 0; c < x.size(); ++c) {
      if (gate.found(c)) out.emplace(c, t - 1);
    }
  }
  return out;
}

// Two resonances shaken by noise, seen by all channels with shares of their own, and a little noise in each.
Record shaken(std::size_t n, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gauss;
  Record x(kChannels, std::vector<double>(n));
  for (const double f : {0.07, 0.33}) {
    double a = 0.0, b = 0.0;
    for (std::size_t t = 0; t < n; ++t) {
      const double now = 1.98 * std::cos(2.0 * std::numbers::pi * f) * a - 0.9801 * b + gauss(random);
      b = a, a = now;
      for (std::size_t c = 0; c < kChannels; ++c) x[c][t] += now * std::cos(0.5 + f * 10.0 * static_cast<double>(c));
    }
  }
  for (auto& channel : x) {
    for (double& value : channel) value += 0.02 * gauss(random);
  }
  return x;
}

double rms(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double value : x) sum += value * value;
  return std::sqrt(sum / static_cast<double>(x.size()));
}

TEST(InnovationGate, FindsWhatTheNeighboursInTimeAllow) {
  Record x = shaken(2000);
  Found wanted;
  for (std::size_t at = 300; at < 2000; at += 171) {
    const std::size_t c = at % kChannels;
    x[c][at] += 8.0 * rms(x[c]);
    wanted.emplace(c, at);
  }
  EXPECT_EQ(found_in(x), wanted);
  OutlierGate gate(1);
  std::size_t n = 0;
  for (const double value : x[0]) n += gate.push(0, value, true) ? 1U : 0U;
  EXPECT_EQ(n, 0U) << "one channel's neighbours in time do not tell";
}

TEST(InnovationGate, KeepsEverySampleOfAShakenStructure) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) EXPECT_TRUE(found_in(shaken(20'000, seed)).empty()) << seed;
}

TEST(InnovationGate, KeepsWhatShakesTwoChannels) {
  Record x = shaken(1000);
  x[0][600] += 100.0, x[2][600] += 60.0;
  EXPECT_TRUE(found_in(x).empty());
}

TEST(InnovationGate, KeepsReleasesImpactsAndSteps) {
  for (const double f : {0.02, 0.1, 0.2, 0.25, 0.35, 0.45}) {
    for (const bool is_release : {false, true}) {
      Record x = shaken(600);
      for (std::size_t t = 300; t < 600; ++t) {
        const double s = static_cast<double>(t) - 300.0, angle = 2.0 * std::numbers::pi * f * s;
        const double decay = 300.0 * std::exp(-0.01 * s) * (is_release ? std::cos(angle) - 1.0 : std::sin(angle));
        for (std::size_t c = 0; c < kChannels; ++c) x[c][t] += decay * static_cast<double>(c + 1) / kChannels;
      }
      const Found found = found_in(x);
      EXPECT_TRUE(found.empty()) << f << (is_release ? " release" : " impact") << ::testing::PrintToString(found);
    }
  }
  Record x = shaken(600);
  for (std::size_t t = 300; t < 600; ++t) x[1][t] += 200.0;
  EXPECT_TRUE(found_in(x).empty()) << "a step of one channel";
}

TEST(InnovationGate, WithoutTwoOthersNothingIsJudged) {
  Record x = shaken(600);
  x[0][400] += 1e3;
  x.resize(2);
  EXPECT_TRUE(found_in(x).empty());
}

TEST(InnovationGate, RefusesAStateThatIsNone) {
  InnovationGate gate(kChannels);
  EXPECT_TRUE(gate.is_consistent());
  gate.state().front().i_next = InnovationGate::kMemory;
  EXPECT_FALSE(gate.is_consistent());
  gate.restart();
  EXPECT_TRUE(gate.is_consistent());
  gate.state().back().filter[3] = std::nan("");
  EXPECT_FALSE(gate.is_consistent());
}

// Also where a segment ends with it.
TEST(InnovationGate, SpectraAreThoseOfTheRecordWithoutTheSample) {
  WelchConfig config;
  config.gate_outliers = true, config.n_channels = kChannels, config.segment = 64, config.rate_hz = 10.0;
  const auto sums = [](const WelchConfig& with, const Record& x) {
    WelchCpsd welch(with);
    for (std::size_t t = 0; t < x.front().size(); ++t) {
      std::vector<double> value;
      std::vector<std::uint8_t> seen;
      for (const auto& channel : x) value.push_back(channel[t]), seen.push_back(std::isfinite(channel[t]) ? 1 : 0);
      (void)welch.push(value, seen);
    }
    welch.flush();
    return welch.sums();
  };
  for (const std::size_t at : {300U, 319U, 320U}) {
    Record x = shaken(500), lost = x;
    x[1][at] += 8.0 * rms(x[1]);
    lost[1][at] = std::nan("");
    WelchConfig ungated = config;
    ungated.gate_outliers = false;
    const CpsdSums a = sums(config, x), b = sums(ungated, lost);
    EXPECT_EQ(a.n_outlying[1], 1U) << at;
    EXPECT_EQ(a.data_sum, b.data_sum) << at;
    EXPECT_EQ(a.mask_sum, b.mask_sum) << at;
    EXPECT_EQ(a.n_missing, b.n_missing) << at;
  }
}

}  // namespace
}  // namespace core
