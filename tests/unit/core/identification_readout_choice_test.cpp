#include "core/identification/readout_choice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace core {
namespace {

TEST(ReadoutChoice, KeepsWhatIsDeclaredWhereNothingIsMeasured) {
  const ReadoutFinding finding = choose_readout({0.026, 0.001}, {}, {});
  EXPECT_EQ(finding.used.readout_s, 0.026);
  EXPECT_EQ(finding.used.std_s, 0.001);
  EXPECT_TRUE(finding.consistent);
  EXPECT_FALSE(finding.from_tracks.has_value());
}

TEST(ReadoutChoice, CombinesByInverseVariance) {
  const ReadoutFinding finding = choose_readout({0.026, 0.002}, ReadoutValue{0.024, 0.001}, {});
  EXPECT_NEAR(finding.used.readout_s, 0.0244, 1e-12);
  EXPECT_NEAR(finding.used.std_s, 0.001 * std::sqrt(0.8), 1e-12);
  EXPECT_TRUE(finding.consistent);
  EXPECT_EQ(finding.why, "declared and estimated from the tracks");
}

TEST(ReadoutChoice, AnExactDeclarationStandsEvenIfItIsContradicted) {
  EXPECT_TRUE(choose_readout({0.026, 0.0}, ReadoutValue{0.0262, 0.0001}, {}).consistent);
  const ReadoutFinding finding = choose_readout({0.026, 0.0}, ReadoutValue{0.016, 0.0001}, {});
  EXPECT_EQ(finding.used.readout_s, 0.026);
  EXPECT_FALSE(finding.consistent);
  EXPECT_NE(finding.why.find("contradicts"), std::string::npos);
}

TEST(ReadoutChoice, OfTwoThatContradictTheBetterKnownStands) {
  const ReadoutFinding finding = choose_readout({0.015, 0.001}, ReadoutValue{0.026, 0.0002}, {});
  EXPECT_EQ(finding.used.readout_s, 0.026);
  EXPECT_EQ(finding.used.std_s, 0.0002);
  EXPECT_FALSE(finding.consistent);
}

TEST(ReadoutChoice, ADeclaredValueGivesWayToALessPreciseMeasurementThatContradictsIt) {
  const ReadoutFinding finding = choose_readout({0.040, 0.001}, ReadoutValue{0.0173, 0.00108}, {});
  EXPECT_EQ(finding.used.readout_s, 0.0173);
  EXPECT_FALSE(finding.consistent);
  EXPECT_NE(finding.why.find("contradicts the declared value"), std::string::npos);
  EXPECT_NEAR(choose_readout({0.040, 0.001}, ReadoutValue{0.036, 0.002}, {}).used.readout_s, 0.0392, 1e-12);
  EXPECT_EQ(choose_readout({0.026, 0.001}, ReadoutValue{0.0342, 0.0016}, {}).used.readout_s, 0.0342);
}

TEST(ReadoutChoice, ALensThatIsNotDeclaredDoesNotDisplaceADeclaredValue) {
  // 3 % off a measurement that states 0.2 %: a strong lens biases it by 2 %.
  const ReadoutFinding finding = choose_readout({0.016, 0.00001}, ReadoutValue{0.01648, 0.00003}, {});
  EXPECT_EQ(finding.used.readout_s, 0.016);
  EXPECT_FALSE(finding.consistent);
  EXPECT_EQ(choose_readout({0.016, 0.00001}, ReadoutValue{0.0168, 0.00003}, {}).used.readout_s, 0.0168);
}

TEST(ReadoutChoice, OfTracksAndShapesThatContradictEachOtherTheMorePreciseStands) {
  const ReadoutFinding finding = choose_readout({0.02, 0.02}, ReadoutValue{0.026, 0.001}, ReadoutValue{0.036, 0.0005});
  EXPECT_NEAR(finding.used.readout_s, 0.036, 2e-5);
  EXPECT_FALSE(finding.consistent);
}

TEST(ReadoutChoice, ShapesJoinTracksOrSpeakForThem) {
  const ReadoutFinding both = choose_readout({0.02, 0.02}, ReadoutValue{0.026, 0.001}, ReadoutValue{0.027, 0.001});
  EXPECT_NEAR(both.used.readout_s, 0.0265, 2e-5);
  const ReadoutFinding alone = choose_readout({0.02, 0.02}, {}, ReadoutValue{0.027, 0.001});
  EXPECT_NEAR(alone.used.readout_s, 0.027, 2e-5);
}

TEST(ReadoutChoice, WhatIsNoNumberIsNotMeasured) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const ReadoutFinding finding = choose_readout({0.02, 0.001}, ReadoutValue{kNan, 0.001}, ReadoutValue{0.03, 0.0});
  EXPECT_EQ(finding.used.readout_s, 0.02);
  EXPECT_FALSE(finding.from_tracks || finding.from_shapes);
}

}  // namespace
}  // namespace core
