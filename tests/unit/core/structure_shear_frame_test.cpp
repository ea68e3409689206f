#include "core/structure/shear_frame.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>

namespace core::structure {
namespace {

ShearFrame uniform(std::size_t n, double k_per_s2) {
  ShearFrame frame;
  frame.mass.assign(n, 1.0);
  frame.stiffness_per_s2.assign(n, k_per_s2);
  return frame;
}

double hz(double rad_per_s) { return rad_per_s / (2.0 * std::numbers::pi); }

TEST(ShearFrame, UniformFrameHasTheClosedFormFrequenciesAndShapes) {
  const auto modes = frame_modes(uniform(6, 1800.0), true);
  ASSERT_TRUE(modes);
  for (int r = 0; r < 6; ++r) {
    const double angle = (2.0 * r + 1.0) * std::numbers::pi / 26.0;
    EXPECT_NEAR(modes->frequency_hz(r), hz(2.0 * std::sqrt(1800.0) * std::sin(angle)), 1e-9);
    const double scale = modes->shapes(0, r) / std::sin(2.0 * angle);
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(modes->shapes(i, r), scale * std::sin(2.0 * angle * (i + 1)), 1e-9);
  }
}

TEST(ShearFrame, OneStoreyOfEachEffectAgreesWithHandCalculation) {
  ShearFrame frame = uniform(1, 100.0);
  frame.rocking_flexibility = 0.5;  // k h^2 / k_r in series: 1 / (1 + 0.5)
  EXPECT_NEAR(frame_modes(frame, false)->frequency_hz(0), hz(std::sqrt(100.0 / 1.5)), 1e-9);
  frame = uniform(1, 100.0);
  frame.bending_flexibility = 0.3;  // tip of a cantilever: h^3 / (3 E I)
  EXPECT_NEAR(frame_modes(frame, false)->frequency_hz(0), hz(std::sqrt(100.0 / 1.1)), 1e-9);
  frame = uniform(1, 100.0);
  frame.gravity_over_height_per_s2 = 20.0;
  EXPECT_NEAR(frame_modes(frame, false)->frequency_hz(0), hz(std::sqrt(80.0)), 1e-9);
  EXPECT_DOUBLE_EQ(stability_coefficient(frame), 0.2);
}

// A column whose top can rotate freely is a cantilever: 3 E I / h^3 instead of 12.
TEST(ShearFrame, FreeJointsLeaveACantilever) {
  ShearFrame frame = uniform(1, 120.0);
  frame.joint_flexibility = 1e9;
  EXPECT_NEAR(stiffness_per_s2(frame)(0, 0), 30.0, 1e-6);
  // Three storeys of one column: the tip of a cantilever three times as high is 27 times softer.
  frame = uniform(3, 120.0);
  frame.joint_flexibility = 1e9;
  EXPECT_NEAR(stiffness_per_s2(frame).inverse()(2, 2), 27.0 / 30.0, 1e-6);
}

TEST(ShearFrame, FlexibilitiesOnlySoften) {
  const auto plain = frame_modes(uniform(5, 400.0), false);
  for (double ShearFrame::*field : {&ShearFrame::joint_flexibility, &ShearFrame::rocking_flexibility,
                                    &ShearFrame::bending_flexibility, &ShearFrame::gravity_over_height_per_s2}) {
    ShearFrame frame = uniform(5, 400.0);
    frame.*field = 0.05;
    const auto modes = frame_modes(frame, false);
    ASSERT_TRUE(modes);
    EXPECT_LT(modes->frequency_hz(0), plain->frequency_hz(0));
    EXPECT_TRUE(((plain->frequency_hz - modes->frequency_hz).array() > -1e-12).all());
  }
}

TEST(ShearFrame, BuckledOrBrokenFramesHaveNoModes) {
  ShearFrame frame = uniform(4, 10.0);
  frame.gravity_over_height_per_s2 = 10.0;
  EXPECT_FALSE(frame_modes(frame, true));
  frame = uniform(4, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(frame_modes(frame, true));
  frame = uniform(4, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(frame_modes(frame, false));
}

}  // namespace
}  // namespace core::structure
