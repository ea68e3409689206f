#include "core/tracking/outlier_rejection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace core {
namespace {

struct Case {
  std::vector<Vector2> motion;
  std::vector<std::uint8_t> valid, inlier, truth;
};

// 40 points that move by (3, -2) with noise; `outliers` of them move arbitrarily.
Case scattered(unsigned seed, int outliers) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gaussian(0.0, 0.1);
  std::uniform_real_distribution<double> anywhere(-25.0, 25.0);
  Case c;
  for (int i = 0; i < 40; ++i) {
    const bool wild = (i * 7) % 40 < outliers;
    Vector2 motion{3.0 + gaussian(random), -2.0 + gaussian(random)};
    if (wild) {
      do motion = {anywhere(random), anywhere(random)};
      while (std::abs(motion.u - 3.0) < 3.0 && std::abs(motion.v + 2.0) < 3.0);
    }
    c.motion.push_back(motion);
    c.truth.push_back(wild ? 0 : 1);
  }
  c.valid.assign(40, 1);
  c.inlier.assign(40, 9);
  return c;
}

// Regions without outliers are classified without hypotheses, regions with outliers with them: the results agree
// bitwise.
TEST(Mlesac, AnOutlierChangesNothingForTheOthers) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    Case c = scattered(seed, 0);
    const MlesacResult alone = mlesac_translation(c.motion, c.valid, {}, c.inlier);
    EXPECT_EQ(c.inlier, c.truth) << "seed " << seed;
    c.motion.push_back({20.0, 20.0});
    c.valid.push_back(1), c.inlier.push_back(9), c.truth.push_back(0);
    const MlesacResult beside = mlesac_translation(c.motion, c.valid, {}, c.inlier);
    EXPECT_EQ(c.inlier, c.truth) << "seed " << seed;
    EXPECT_EQ(beside.motion.u, alone.motion.u);
    EXPECT_EQ(beside.motion.v, alone.motion.v);
  }
}

TEST(Mlesac, RejectsThirtyPercentOutliers) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    Case c = scattered(seed, 12);
    const MlesacResult result = mlesac_translation(c.motion, c.valid, {}, c.inlier);
    EXPECT_EQ(c.inlier, c.truth) << "seed " << seed;
    EXPECT_EQ(result.n_inliers, 28);
    EXPECT_NEAR(result.motion.u, 3.0, 0.1);
    EXPECT_NEAR(result.motion.v, -2.0, 0.1);
  }
}

TEST(Mlesac, KeepsAllPointsWhenAllAgree) {
  Case c = scattered(3, 0);
  EXPECT_EQ(mlesac_translation(c.motion, c.valid, {}, c.inlier).n_inliers, 40);
}

TEST(Mlesac, GivesTheSameAnswerAgainAndInAnyOrder) {
  Case a = scattered(8, 12);
  Case b = scattered(8, 12);
  const MlesacResult first = mlesac_translation(a.motion, a.valid, {}, a.inlier);
  const MlesacResult again = mlesac_translation(b.motion, b.valid, {}, b.inlier);
  EXPECT_EQ(first.motion.u, again.motion.u);
  EXPECT_EQ(a.inlier, b.inlier);
  std::reverse(b.motion.begin(), b.motion.end());
  std::reverse(b.truth.begin(), b.truth.end());
  const MlesacResult reversed = mlesac_translation(b.motion, b.valid, {}, b.inlier);
  EXPECT_NEAR(reversed.motion.u, first.motion.u, 1e-12);
  EXPECT_EQ(b.inlier, b.truth);
}

TEST(Mlesac, IgnoresInvalidPointsWhateverTheyHold) {
  Case c = scattered(4, 0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < 40; i += 3) {
    c.valid[i] = 0;
    c.motion[i] = {nan, 1e300};
  }
  const MlesacResult result = mlesac_translation(c.motion, c.valid, {}, c.inlier);
  EXPECT_EQ(result.n_inliers, 26);
  EXPECT_NEAR(result.motion.u, 3.0, 0.1);
  for (std::size_t i = 0; i < 40; ++i) EXPECT_EQ(c.inlier[i], i % 3 == 0 ? 0 : 1);
}

TEST(Mlesac, WithoutAPointThereIsNoInlier) {
  std::vector<std::uint8_t> inlier(2, 9);
  const std::vector<Vector2> motion(2);
  const std::vector<std::uint8_t> none(2, 0);
  const MlesacResult result = mlesac_translation(motion, none, {}, inlier);
  EXPECT_EQ(result.n_inliers, 0);
  EXPECT_EQ(inlier, none);
  EXPECT_EQ(mlesac_translation({}, {}, {}, {}).n_inliers, 0);
}

TEST(Mlesac, ALonePointIsItsOwnInlier) {
  const std::vector<Vector2> motion{{7.0, 8.0}};
  std::vector<std::uint8_t> valid(1, 1), inlier(1, 0);
  const MlesacResult result = mlesac_translation(motion, valid, {}, inlier);
  EXPECT_EQ(result.n_inliers, 1);
  EXPECT_EQ(result.motion.u, 7.0);
}

}  // namespace
}  // namespace core
