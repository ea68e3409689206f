#include "core/tracking/motion_predictor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace core {
namespace {

// Largest error of the last half of 200 predictions, divided by that of predicting no motion.
double share_of_staying(const std::function<double(int)>& motion) {
  MotionPredictor predictor;
  double worst = 0.0, worst_stays = 0.0;
  for (int k = 0; k < 200; ++k) {
    predictor.update({motion(k), 0.0}, false);
    const double step = motion(k + 1) - motion(k);
    if (k < 100) continue;
    worst = std::max(worst, std::abs(predictor.step().u - step));
    worst_stays = std::max(worst_stays, std::abs(step));
  }
  return worst / worst_stays;
}

TEST(MotionPredictor, FollowsADrift) {
  EXPECT_LT(share_of_staying([](int k) { return 7.0 * k; }), 0.01);
}

// At 30 frames a second: 1.7 Hz, where extrapolation is good, and 9 Hz, where it is worse than no motion.
TEST(MotionPredictor, FollowsVibration) {
  for (const double hz : {1.7, 5.0, 9.0, 14.0}) {
    EXPECT_LT(share_of_staying([&](int k) { return 12.0 * std::sin(2.0 * std::numbers::pi * hz * k / 30.0); }), 0.05)
        << hz << " Hz";
  }
}

TEST(MotionPredictor, NoiseIsNotFollowed) {
  // A hash, not a sequence: no step can be predicted.
  const auto noise = [](int k) { return std::fmod(std::abs(std::sin(k * 12.9898) * 43758.5453), 1.0) - 0.5; };
  EXPECT_LT(share_of_staying(noise), 1.2);
}

TEST(MotionPredictor, AfterAGapItStaysUntilItKnowsMore) {
  MotionPredictor predictor;
  for (int k = 0; k < 50; ++k) predictor.update({5.0 * k, -3.0 * k}, false);
  EXPECT_NEAR(predictor.step().u, 5.0, 1e-6);
  EXPECT_NEAR(predictor.step().v, -3.0, 1e-6);
  predictor.update({400.0, -240.0}, true);
  EXPECT_EQ(predictor.step().u, 0.0);
  predictor.forget();
  EXPECT_EQ(predictor.step().v, 0.0);
}

TEST(MotionPredictor, AJumpDoesNotSendItFar) {
  MotionPredictor predictor;
  for (int k = 0; k < 20; ++k) predictor.update({k == 10 ? 1e6 : 0.0, 0.0}, false);
  EXPECT_LE(std::abs(predictor.step().u), 100.0);
}

}  // namespace
}  // namespace core
