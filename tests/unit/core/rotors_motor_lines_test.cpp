#include "core/rotors/motor_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

namespace {

using core::ModalEstimate;
using core::Mode;
using core::MotorLines;
using core::Verdict;

constexpr double kRate_hz = 25.0, kResolution_hz = 0.02;
const std::vector<double> kDelay_s{0.0, 0.006, 0.012, 0.018, 0.024, 0.03};

Mode mode_at(double hz, double damping, Verdict verdict = Verdict::kStructural) {
  Mode mode;
  mode.frequency_hz = hz;
  mode.apparent_hz = std::abs(std::remainder(hz, kRate_hz));
  mode.damping_ratio = damping;
  mode.verdict = verdict;
  mode.reason = "as found";
  return mode;
}

ModalEstimate estimate_of(std::vector<Mode> modes, std::vector<Mode> rejected = {}) {
  ModalEstimate out;
  out.rate_hz = kRate_hz;
  out.resolution_hz = kResolution_hz;
  out.modes = std::move(modes);
  out.rejected = std::move(rejected);
  return out;
}

TEST(MotorLines, AppearWhereTheSamplesFoldThem) {
  const MotorLines lines({{3, 95.2, 0.02}});
  const auto line = lines.at(4.79, kRate_hz, kResolution_hz);
  ASSERT_TRUE(line);
  EXPECT_EQ(line->multiple, 1);
  EXPECT_NEAR(line->apparent_hz, 4.8, 1e-9);  // 4 x 25 - 95.2
  EXPECT_EQ(words_of(*line), "the rate of motor 3, 95.20 +- 0.02 Hz, appears at 4.80 Hz");
  EXPECT_EQ(lines.at(9.6, kRate_hz, kResolution_hz)->multiple, 2);
  EXPECT_EQ(lines.at(10.6, kRate_hz, kResolution_hz)->multiple, 3);
  EXPECT_FALSE(lines.at(3.0, kRate_hz, kResolution_hz));
}

// Six channels over 30 ms of readout, as a camera sees them that is shifted and rolled at this signed frequency; the
// mode is believed to have its apparent frequency.
Mode camera_mode(double signed_hz) {
  Mode mode = mode_at(std::abs(std::remainder(signed_hz, kRate_hz)), 0.002);
  mode.fold_n = 0;
  const double away = std::abs(std::remainder(signed_hz - mode.apparent_hz, kRate_hz));
  const double hz = away < 1e-6 ? signed_hz : -signed_hz;
  for (std::size_t c = 0; c < kDelay_s.size(); ++c) {
    mode.shape.push_back(std::complex(0.4, 0.2 * static_cast<double>(c)) *
                         std::polar(1.0, 6.283185307179586 * (hz - mode.apparent_hz) * kDelay_s[c]));
  }
  return mode;
}

TEST(MotorLines, AVibrationOfTheCameraAtTheRateOfAMotorIsNoMode) {
  ModalEstimate estimate =
      estimate_of({mode_at(1.6, 0.01), camera_mode(95.2), mode_at(7.0, 0.01)},
                  {mode_at(9.6, 0.0001, Verdict::kHarmonic), mode_at(2.2, 0.2, Verdict::kNumerical)});
  for (int i = 0; i < 5; ++i) estimate.poles.push_back({.i_line = i});
  MotorLines({{3, 95.2, 0.02}}).judge(estimate, kDelay_s);
  ASSERT_EQ(estimate.modes.size(), 2U);
  ASSERT_EQ(estimate.rejected.size(), 3U);
  EXPECT_EQ(estimate.modes[1].frequency_hz, 7.0);
  EXPECT_EQ(estimate.rejected[0].verdict, Verdict::kCameraMotion);
  EXPECT_NE(estimate.rejected[0].reason.find("the rate of motor 3"), std::string::npos);
  EXPECT_EQ(estimate.rejected[1].verdict, Verdict::kHarmonic);
  EXPECT_NE(estimate.rejected[1].reason.find("twice the rate of motor 3"), std::string::npos);
  EXPECT_EQ(estimate.rejected[2].reason, "as found");
  std::vector<int> places;
  for (const auto& pole : estimate.poles) places.push_back(pole.i_line);
  EXPECT_EQ(places, (std::vector<int>{0, 2, 1, 3, 4}));
}

// 105.2 Hz appears at 5.2 Hz with its own sign, 95.2 Hz at 4.8 Hz with the other.
TEST(MotorLines, EitherSignOfTheAliasIsFound) {
  ModalEstimate estimate = estimate_of({camera_mode(95.2), camera_mode(105.2)});
  MotorLines({{1, 105.2, 0.02}, {3, 95.2, 0.02}}).judge(estimate, kDelay_s);
  EXPECT_TRUE(estimate.modes.empty());
}

TEST(MotorLines, AModeOfTheStructureInALineStays) {
  Mode mode = mode_at(4.8, 0.002);
  for (std::size_t c = 0; c < kDelay_s.size(); ++c) mode.shape.emplace_back(0.2 * static_cast<double>(c), 0.0);
  ModalEstimate estimate = estimate_of({mode});
  MotorLines({{3, 95.2, 0.02}}).judge(estimate, kDelay_s);
  ASSERT_EQ(estimate.modes.size(), 1U);
  EXPECT_EQ(estimate.modes[0].verdict, Verdict::kStructural);
  EXPECT_EQ(estimate.modes[0].reason, "as found");
}

TEST(MotorLines, WithoutRowDelaysNoModeIsTakenAway) {
  ModalEstimate estimate = estimate_of({camera_mode(95.2)});
  MotorLines({{3, 95.2, 0.02}}).judge(estimate, std::vector<double>(6, 0.0));
  ASSERT_EQ(estimate.modes.size(), 1U);
  EXPECT_NE(estimate.modes[0].reason.find("motor 3"), std::string::npos);
}

TEST(MotorLines, WithoutMotorsNothingChanges) {
  ModalEstimate estimate = estimate_of({camera_mode(95.2)});
  MotorLines().judge(estimate, kDelay_s);
  ASSERT_EQ(estimate.modes.size(), 1U);
  EXPECT_EQ(estimate.modes[0].reason, "as found");
}

TEST(MotorLines, ARotorLineNamesItsMotor) {
  core::closure::ClosureResult result;
  core::closure::ClosureStep line;
  line.id.key = "rotor_line";
  line.parameters = {{"frequency", "Hz", 95.2, 0.001}, {"apparent frequency", "Hz", 4.8, 0.001}};
  core::closure::ClosureStep other = line;
  other.parameters[1].value = 3.0;
  core::closure::ClosureStep roll;
  roll.id.key = "roll";
  roll.parameters = line.parameters;
  result.steps = {line, other, roll};
  MotorLines({{3, 95.2, 0.02}}).name(result, kRate_hz, 120.0);
  EXPECT_EQ(result.steps[0].meaning, "the rate of motor 3, 95.20 +- 0.02 Hz, appears at 4.80 Hz");
  EXPECT_EQ(result.steps[1].meaning, "no motor's rate, doubled or tripled, appears there");
  EXPECT_TRUE(result.steps[2].meaning.empty());
}

}  // namespace
