#include "core/geometry/point_correction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace core {
namespace {

TEST(PointCorrection, NothingIsCorrectedUnlessTold) {
  const PointCorrection none;
  EXPECT_FALSE(none.corrects());
  const Vector2 place = none.corrected({123.4, 56.7});
  EXPECT_EQ(place.u, 123.4);
  EXPECT_EQ(place.v, 56.7);
}

TEST(PointCorrection, UndoesPixelLockingAtEveryPlaceWithinAPixel) {
  PointCorrection c;
  c.locking_px = {0.05, -0.02, 0.01, 0.005};
  EXPECT_TRUE(c.corrects());
  const auto error = [&](double p) {
    const double t = 2.0 * std::numbers::pi * p;
    return 0.05 * std::sin(t) - 0.02 * std::cos(t) + 0.01 * std::sin(2.0 * t) + 0.005 * std::cos(2.0 * t);
  };
  for (int i = 0; i < 40; ++i) {
    const double u = 100.0 + 0.025 * i, v = 900.5 - 0.025 * i;
    const Vector2 place = c.corrected({u + error(u), v + error(v)});
    EXPECT_NEAR(place.u, u, 1e-6) << i;
    EXPECT_NEAR(place.v, v, 1e-6) << i;
  }
}

TEST(PointCorrection, UndoesALensBeyondTheDeclaredOne) {
  PointCorrection c;
  c.lens = {1500.0, 1500.0, 959.5, 539.5, {-0.1, 0.0, 0.01, -0.005}};
  EXPECT_TRUE(c.corrects());
  const Vector2 ideal{1500.0, 200.0}, seen = c.lens.distort(ideal), back = c.corrected(seen);
  EXPECT_GT(std::hypot(seen.u - ideal.u, seen.v - ideal.v), 1.0);
  EXPECT_NEAR(back.u, ideal.u, 1e-6);
  EXPECT_NEAR(back.v, ideal.v, 1e-6);
}

}  // namespace
}  // namespace core
