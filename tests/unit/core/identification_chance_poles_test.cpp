#include "core/identification/chance_poles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/identification/mode_sigmas.h"

namespace core {
namespace {

constexpr double kDuration_s = 200.0;

// sigma_times: of the frequency, times the least one.
std::vector<Mode> one_mode(double presence, double sigma_times, Verdict verdict = Verdict::kStructural) {
  Mode mode;
  mode.verdict = verdict;
  mode.frequency_hz = 7.0, mode.damping_ratio = 0.015, mode.presence = presence;
  mode.frequency_std_hz = sigma_times * std::sqrt(least_variances(mode, kDuration_s).frequency_hz);
  mode.damping_std = 0.003;
  mode.shape_std = {0.2, 0.0};
  return {mode};
}

TEST(LeastVariances, AreThoseOfAnUnknownForce) {
  const Mode mode = one_mode(1.0, 1.0)[0];
  const double turns = 2.0 * std::numbers::pi * 7.0 * kDuration_s;
  EXPECT_NEAR(std::sqrt(least_variances(mode, kDuration_s).frequency_hz), 7.0 * std::sqrt(0.015 / turns), 1e-12);
  EXPECT_NEAR(std::sqrt(least_variances(mode, kDuration_s).damping_ratio), 0.015 / std::sqrt(0.015 * turns), 1e-12);
}

// A mode that every order splits into two poles, the second one 2 % off and more damped.
TEST(SpreadOverOrders, OfAFrequencyTakesOnePoleOfEachOrderOfADampingBoth) {
  const auto pole = [](int i_order, double hz, double zeta) {
    const double omega = 2.0 * std::numbers::pi * hz;
    OrderPole out;
    out.i_order = i_order, out.pole.s = {-zeta * omega, omega * std::sqrt(1.0 - zeta * zeta)};
    return out;
  };
  std::vector<OrderPole> poles;
  PoleCluster line;
  line.frequency_hz = 5.0, line.damping_ratio = 0.01, line.representative = pole(0, 5.0, 0.01).pole;
  for (const double off : {-0.004, -0.002, 0.0, 0.002, 0.004}) {
    const int i_order = static_cast<int>(poles.size() / 2);
    poles.push_back(pole(i_order, 5.1, 0.03));
    poles.push_back(pole(i_order, 5.0 + off, 0.01 + off));
  }
  for (std::size_t i = 0; i < poles.size(); ++i) line.members.push_back(i);
  const ModeVariances spread = spread_over_orders(line, poles);
  EXPECT_NEAR(std::sqrt(spread.frequency_hz), 1.4826 * 0.002, 1e-5);
  // |zeta - 0.01| is 0, 0.002, 0.002, 0.004, 0.004 and five times 0.02: the upper median is 0.02
  EXPECT_NEAR(std::sqrt(spread.damping_ratio), 1.4826 * 0.02, 1e-5);
}

TEST(ChancePoles, APoleMissingInAnOrderAndPoorlyKnownIsNumerical) {
  for (const Verdict verdict : {Verdict::kStructural, Verdict::kAmbiguous}) {
    std::vector<Mode> modes = one_mode(14.0 / 15.0, 3.5, verdict);
    reject_chance_poles({false}, kDuration_s, modes);
    EXPECT_EQ(modes[0].verdict, Verdict::kNumerical);
    EXPECT_NE(modes[0].reason.find("93 % of the orders"), std::string::npos) << modes[0].reason;
    EXPECT_NE(modes[0].reason.find("3.5 times better"), std::string::npos) << modes[0].reason;
    EXPECT_FALSE(modes[0].frequency_std_hz || modes[0].damping_std);
    EXPECT_TRUE(modes[0].shape_std.empty());
  }
}

TEST(ChancePoles, APoleOfAllOrdersOrWithAWellKnownFrequencyStays) {
  for (const auto& [presence, times] : {std::pair(1.0, 10.0), std::pair(13.0 / 15.0, 2.5)}) {
    std::vector<Mode> modes = one_mode(presence, times);
    reject_chance_poles({false}, kDuration_s, modes);
    EXPECT_EQ(modes[0].verdict, Verdict::kStructural) << presence;
    EXPECT_TRUE(modes[0].frequency_std_hz.has_value());
  }
}

TEST(ChancePoles, WithoutASigmaOrDampingThereIsNothingToCompare) {
  std::vector<Mode> modes = one_mode(0.9, 10.0), undamped = one_mode(0.9, 10.0);
  modes[0].frequency_std_hz.reset();
  undamped[0].damping_ratio = -0.001;
  modes.push_back(undamped[0]);
  modes.push_back(one_mode(0.9, 10.0, Verdict::kCandidate)[0]);
  reject_chance_poles({false, false, false}, kDuration_s, modes);
  EXPECT_EQ(modes[0].verdict, Verdict::kStructural);
  EXPECT_EQ(modes[1].verdict, Verdict::kStructural);
  EXPECT_EQ(modes[2].verdict, Verdict::kCandidate);
}

// An estimate of two modes, the second one with this sigma of its 9 Hz, and of one rejected pole between them.
ModalEstimate estimate_of(double sigma_hz) {
  ModalEstimate estimate;
  estimate.modes = {one_mode(1.0, 1.0)[0], one_mode(1.0, 1.0)[0]};
  estimate.modes[1].frequency_hz = 9.0, estimate.modes[1].frequency_std_hz = sigma_hz;
  estimate.rejected.push_back(one_mode(0.5, 1.0, Verdict::kNumerical)[0]);
  estimate.rejected[0].frequency_hz = 8.0;
  for (const int line : {0, 1, 2, 2, 0}) {
    estimate.poles.emplace_back();
    estimate.poles.back().i_line = line;
  }
  return estimate;
}

TEST(VagueModes, AFrequencyKnownWorseThanToATenthIsNoModesAndTheDiagramFollows) {
  ModalEstimate estimate = estimate_of(0.95);
  reject_vague_modes(estimate);
  ASSERT_EQ(estimate.modes.size(), 1U);
  ASSERT_EQ(estimate.rejected.size(), 2U);
  EXPECT_DOUBLE_EQ(estimate.rejected[1].frequency_hz, 9.0);
  EXPECT_EQ(estimate.rejected[1].verdict, Verdict::kNumerical);
  EXPECT_NE(estimate.rejected[1].reason.find("a frequency known to 0.95 Hz"), std::string::npos)
      << estimate.rejected[1].reason;
  const std::vector<int> lines{0, 2, 1, 1, 0};  // the rejected poles in the order of their frequencies
  for (std::size_t i = 0; i < lines.size(); ++i) EXPECT_EQ(estimate.poles[i].i_line, lines[i]) << i;
}

// A sigma of 0.27 Hz is 26 times the least one.
TEST(VagueModes, ABetterKnownOneStaysAndWithoutASigmaThereIsNothingToCompare) {
  ModalEstimate known = estimate_of(0.27), unknown = estimate_of(0.95);
  unknown.modes[1].frequency_std_hz.reset();
  for (ModalEstimate* estimate : {&known, &unknown}) {
    reject_vague_modes(*estimate);
    EXPECT_EQ(estimate->modes.size(), 2U);
    EXPECT_EQ(estimate->poles[2].i_line, 2);
  }
}

// Found at high orders only, whatever its verdict is so far.
TEST(ChancePoles, ALatePoleIsAModeOnlyIfItsFrequencyIsKnown) {
  for (const Verdict verdict : {Verdict::kStructural, Verdict::kAmbiguous, Verdict::kCandidate}) {
    std::vector<Mode> modes = one_mode(12.0 / 15.0, 2.0, verdict);
    modes.push_back(one_mode(12.0 / 15.0, 3.5, verdict)[0]);
    modes.push_back(modes[0]);
    modes[2].frequency_std_hz.reset();
    reject_chance_poles({true, true, true}, kDuration_s, modes);
    EXPECT_EQ(modes[0].verdict, verdict);
    EXPECT_TRUE(modes[0].frequency_std_hz.has_value());
    EXPECT_EQ(modes[1].verdict, Verdict::kNumerical);
    EXPECT_EQ(modes[2].verdict, Verdict::kNumerical);
    EXPECT_NE(modes[2].reason.find("without a sigma"), std::string::npos) << modes[2].reason;
  }
}

TEST(ChancePoles, ALatePoleWithAnotherVerdictKeepsIt) {
  std::vector<Mode> modes = one_mode(12.0 / 15.0, 10.0, Verdict::kHarmonic);
  reject_chance_poles({true}, kDuration_s, modes);
  EXPECT_EQ(modes[0].verdict, Verdict::kHarmonic);
}

}  // namespace
}  // namespace core
