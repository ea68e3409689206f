#include <gtest/gtest.h>

#include <complex>
#include <string>
#include <vector>

#include "core/identification/similar_modes.h"

namespace core {
namespace {

Mode structural(double hz, double presence, double mpc, std::vector<std::complex<double>> shape) {
  Mode mode;
  mode.verdict = Verdict::kStructural;
  mode.frequency_hz = hz;
  mode.presence = presence;
  mode.mpc = mpc;
  mode.shape = std::move(shape);
  return mode;
}

TEST(Twins, TheOneOfFewerOrdersIsRejectedAndNamesTheOther) {
  std::vector<Mode> modes{structural(3.00, 0.90, 0.999, {0.4, 1.0}), structural(3.10, 1.00, 0.95, {0.4, 1.0})};
  reject_twins(modes);
  EXPECT_EQ(modes[0].verdict, Verdict::kNumerical);
  EXPECT_NE(modes[0].reason.find("3.1000"), std::string::npos) << modes[0].reason;
  EXPECT_EQ(modes[1].verdict, Verdict::kStructural);
}

TEST(Twins, OfEqualPresenceTheLessCollinearIsRejected) {
  std::vector<Mode> modes{structural(3.00, 1.0, 0.999, {0.4, 1.0}), structural(3.10, 1.0, 0.95, {0.4, 1.0})};
  reject_twins(modes);
  EXPECT_EQ(modes[0].verdict, Verdict::kStructural);
  EXPECT_EQ(modes[1].verdict, Verdict::kNumerical);
}

TEST(Twins, AnotherShapeOrAnotherFrequencyIsNoTwin) {
  std::vector<Mode> modes{structural(3.0, 1.0, 0.99, {0.4, 1.0}), structural(3.1, 0.9, 0.99, {1.0, -0.4}),
                          structural(3.4, 0.9, 0.99, {0.4, 1.0})};
  reject_twins(modes);
  for (const Mode& mode : modes) EXPECT_EQ(mode.verdict, Verdict::kStructural) << mode.frequency_hz;
}

TEST(Twins, OneWithNextToNoDampingIsASteadyForceBesideTheMode) {
  for (const bool line_first : {true, false}) {
    std::vector<Mode> modes{structural(3.0, 0.9, 0.9, {0.4, 1.0}), structural(3.1, 1.0, 0.99, {0.4, 1.0})};
    const std::size_t line = line_first ? 0 : 1;
    modes[line].damping_ratio = 1e-5;
    modes[1 - line].damping_ratio = 0.01;
    reject_twins(modes);
    EXPECT_EQ(modes[line].verdict, Verdict::kHarmonic);
    EXPECT_EQ(modes[1 - line].verdict, Verdict::kStructural) << "whatever the presence";
    EXPECT_NE(modes[line].reason.find("steady force"), std::string::npos) << modes[line].reason;
  }
}

TEST(Twins, TwoOfLittleDampingAreNoLineAndItsMode) {
  std::vector<Mode> modes{structural(3.0, 0.9, 0.99, {0.4, 1.0}), structural(3.1, 1.0, 0.99, {0.4, 1.0})};
  modes[0].damping_ratio = 0.0008;
  modes[1].damping_ratio = 0.0015;
  reject_twins(modes);
  EXPECT_EQ(modes[0].verdict, Verdict::kNumerical);
  EXPECT_EQ(modes[1].verdict, Verdict::kStructural);
}

TEST(Twins, ARejectedPoleHasNoTwin) {
  std::vector<Mode> modes{structural(3.0, 0.9, 0.99, {0.4, 1.0}), structural(3.1, 1.0, 0.99, {0.4, 1.0})};
  modes[1].verdict = Verdict::kInputPeak;
  reject_twins(modes);
  EXPECT_EQ(modes[0].verdict, Verdict::kStructural);
}

TEST(Twins, OfTripletsOneIsLeft) {
  std::vector<Mode> modes{structural(3.0, 0.9, 0.99, {0.4, 1.0}), structural(3.05, 1.0, 0.99, {0.4, 1.0}),
                          structural(3.1, 0.95, 0.99, {0.4, 1.0})};
  reject_twins(modes);
  EXPECT_EQ(modes[1].verdict, Verdict::kStructural);
  EXPECT_EQ(modes[0].verdict, Verdict::kNumerical);
  EXPECT_EQ(modes[2].verdict, Verdict::kNumerical);
}

}  // namespace
}  // namespace core
