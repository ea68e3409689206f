#include "core/geometry/scale_factor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace core {
namespace {

constexpr double kCx = 320.0;
constexpr double kCy = 240.0;

// Three floors moving along u (axis_deg 0), one above the other, and a background that is farther away.
std::vector<ScaleFactor::Point> floors_and_background() {
  std::vector<ScaleFactor::Point> points;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (std::uint16_t region = 0; region < 4; ++region) {
    for (int i = 0; i < 12; ++i) {
      const double v = region < 3 ? 80.0 + 130.0 * region : 20.0;
      points.push_back({{200.0 + 240.0 * unit(random), v + 40.0 * unit(random)}, region, 1.0, 0.0, false, region < 3});
    }
  }
  return points;
}

// The image after the floors moved by `floor_px` (keyframe px) along u and the camera magnified by b and shifted.
std::vector<Vector2> seen(const std::vector<ScaleFactor::Point>& points, double b, double background_b,
                          const double (&floor_px)[3]) {
  std::vector<Vector2> position;
  for (const ScaleFactor::Point& p : points) {
    const double motion = p.region < 3 ? floor_px[p.region] : 0.0;
    const double m = p.region < 3 ? b : background_b;
    position.push_back({kCx + m * (p.keyframe.u + motion - kCx) + 11.0, kCy + m * (p.keyframe.v - kCy) - 7.0});
  }
  return position;
}

constexpr double kMoving[3] = {4.0, -9.0, 15.0};
constexpr double kAtRest[3] = {0.0, 0.0, 0.0};

TEST(ScaleFactor, FindsTheMagnificationUnderMovingFloors) {
  const std::vector<ScaleFactor::Point> points = floors_and_background();
  const std::vector<std::uint8_t> usable(points.size(), 1);
  for (const double b : {0.95, 1.0, 1.02}) {
    ScaleFactor scale(points);
    const std::vector<Vector2> position = seen(points, b, 1.3, kMoving);
    EXPECT_NEAR(scale.median_of_pairs(position, usable), b, 1e-12);
    EXPECT_NEAR(scale.least_squares(position, usable), b, 1e-12);
  }
}

TEST(ScaleFactor, TheBackgroundTakesNoPart) {
  std::vector<ScaleFactor::Point> points = floors_and_background();
  const std::vector<std::uint8_t> usable(points.size(), 1);
  ScaleFactor scale(points);
  EXPECT_NEAR(scale.two_point(seen(points, 1.01, 1.4, kAtRest), usable), 1.01, 1e-12);
  EXPECT_NEAR(scale.least_squares(seen(points, 1.01, 1.4, kAtRest), usable), 1.01, 1e-12);
}

// The paper's two points lie on different floors: their distance follows the floors' relative motion.
TEST(ScaleFactor, TwoPointsTakeFloorMotionForMagnification) {
  const std::vector<ScaleFactor::Point> points = floors_and_background();
  const std::vector<std::uint8_t> usable(points.size(), 1);
  ScaleFactor scale(points);
  EXPECT_GT(std::abs(scale.two_point(seen(points, 1.0, 1.0, kMoving), usable) - 1.0), 1e-3);
}

TEST(ScaleFactor, TwoPointFallsBackToTheNextPairWhenOneIsLost) {
  const std::vector<ScaleFactor::Point> points = floors_and_background();
  const std::vector<Vector2> position = seen(points, 1.03, 1.0, kAtRest);
  ScaleFactor scale(points);
  for (std::size_t lost = 0; lost < points.size(); ++lost) {
    std::vector<std::uint8_t> usable(points.size(), 1);
    usable[lost] = 0;
    EXPECT_NEAR(scale.two_point(position, usable), 1.03, 1e-12);
  }
}

TEST(ScaleFactor, KeepsItsLastValueWhenNothingIsSeen) {
  const std::vector<ScaleFactor::Point> points = floors_and_background();
  const std::vector<Vector2> position = seen(points, 1.03, 1.0, kAtRest);
  const std::vector<std::uint8_t> all(points.size(), 1);
  const std::vector<std::uint8_t> none(points.size(), 0);
  ScaleFactor scale(points);
  EXPECT_EQ(scale.least_squares(position, none), 1.0);
  EXPECT_EQ(scale.median_of_pairs(position, none), 1.0);
  const double b = scale.least_squares(position, all);
  EXPECT_EQ(scale.least_squares(position, none), b);
  EXPECT_EQ(scale.two_point(position, none), b);
}

TEST(ScaleFactor, TheMedianShrugsOffAFewWildPoints) {
  const std::vector<ScaleFactor::Point> points = floors_and_background();
  const std::vector<std::uint8_t> usable(points.size(), 1);
  std::vector<Vector2> position = seen(points, 1.02, 1.0, kMoving);
  for (const std::size_t wild : {1U, 14U, 27U}) position[wild] = {position[wild].u + 60.0, position[wild].v - 45.0};
  ScaleFactor scale(points);
  EXPECT_NEAR(scale.median_of_pairs(position, usable), 1.02, 0.005);
}

// A region that may move along both axes shows magnification only within itself.
TEST(ScaleFactor, RegionsThatMoveBothWaysAreNotComparedWithOthers) {
  std::vector<ScaleFactor::Point> points = floors_and_background();
  for (ScaleFactor::Point& p : points) p.both_axes = true;
  std::vector<Vector2> position = seen(points, 1.01, 1.0, kMoving);
  for (std::size_t i = 0; i < 12; ++i) position[i].v += 13.0;
  const std::vector<std::uint8_t> usable(points.size(), 1);
  ScaleFactor scale(points);
  EXPECT_NEAR(scale.median_of_pairs(position, usable), 1.01, 1e-12);
  EXPECT_NEAR(scale.least_squares(position, usable), 1.01, 1e-12);
}

TEST(ScaleFactor, DegenerateSetsGiveOneNeverNaN) {
  ScaleFactor none({});
  EXPECT_EQ(none.least_squares({}, {}), 1.0);
  EXPECT_EQ(none.median_of_pairs({}, {}), 1.0);
  EXPECT_EQ(none.two_point({}, {}), 1.0);
  const std::vector<Vector2> twice{{50.0, 50.0}, {50.0, 50.0}};
  const std::vector<std::uint8_t> usable(2, 1);
  ScaleFactor same({{{50.0, 50.0}, 0, 1.0, 0.0, false, true}, {{50.0, 50.0}, 0, 1.0, 0.0, false, true}});
  EXPECT_EQ(same.least_squares(twice, usable), 1.0);
  EXPECT_EQ(same.median_of_pairs(twice, usable), 1.0);
  EXPECT_EQ(same.two_point(twice, usable), 1.0);
}

}  // namespace
}  // namespace core
