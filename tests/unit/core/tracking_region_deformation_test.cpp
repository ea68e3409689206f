#include "core/tracking/region_deformation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/tracking/point_finder.h"
#include "tests/support/analytic_texture.h"
#include "tests/support/gray_view.h"

namespace core {
namespace {

using test_support::AnalyticTexture;
using test_support::view;
constexpr int kWidth = 360, kHeight = 280;
constexpr Vector2 kMiddle{180.0, 140.0};

// The texture, deformed about the image's middle and translated: true position of the keyframe's point x.
struct Motion {
  Deformation a;
  Vector2 shift;
  [[nodiscard]] Vector2 of(const Vector2& x) const {
    const Vector2 moved = a.of({x.u - kMiddle.u, x.v - kMiddle.v});
    return {x.u + moved.u + shift.u, x.v + moved.v + shift.v};
  }
  [[nodiscard]] Vector2 back(const Vector2& p) const {
    const double m00 = 1.0 + a.uu, m11 = 1.0 + a.vv, determinant = m00 * m11 - a.uv * a.vu;
    const Vector2 q{p.u - kMiddle.u - shift.u, p.v - kMiddle.v - shift.v};
    return {kMiddle.u + (m11 * q.u - a.uv * q.v) / determinant, kMiddle.v + (m00 * q.v - a.vu * q.u) / determinant};
  }
};

cv::Mat image(const AnalyticTexture& texture, const Motion& motion, double noise, unsigned seed) {
  cv::Mat out(kHeight, kWidth, CV_8UC1);
  std::mt19937 random(seed);
  std::normal_distribution<double> gaussian(0.0, noise);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const Vector2 from = motion.back({static_cast<double>(u), static_cast<double>(v)});
      out.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(texture.at(from.u, from.v) + gaussian(random));
    }
  }
  return out;
}

// Two regions of points between pixels.
struct Points {
  std::vector<Vector2> keyframe;
  std::vector<std::uint16_t> region;
  Points() {
    for (int r = 0; r < 2; ++r) {
      for (int k = 0; k < 20; ++k) {
        keyframe.push_back({80.3 + 40.0 * (k % 5), 60.4 + 90.0 * r + 20.0 * (k / 5)});
        region.push_back(static_cast<std::uint16_t>(r));
      }
    }
  }
};

struct Rig {
  AnalyticTexture texture{17, 7.0};
  Points points;
  RegionFollower follower{RegionFollowerConfig{kWidth, kHeight}, points.keyframe, points.region, 2};
  PointFinder finder{{}, view(image(texture, {}, 1.0, 1)), points.keyframe, points.region, 2};
  unsigned seed = 2;

  // rms error of points that are seen; all must be.
  double error(const Motion& motion) {
    finder.find(view(image(texture, motion, 1.0, seed++)), follower);
    TrackFrame judged;
    double sum = 0.0, stated = 0.0;
    for (std::size_t i = 0; i < points.keyframe.size(); ++i) {
      const KltPoint& p = finder.points()[i];
      EXPECT_TRUE(p.seen) << i;
      const Vector2 truth = motion.of(points.keyframe[i]);
      sum += (p.position.u - truth.u) * (p.position.u - truth.u) + (p.position.v - truth.v) * (p.position.v - truth.v);
      stated += p.sigma_px * p.sigma_px;
      judged.points.push_back({p.position.u, p.position.v, p.sigma_px, 0, points.region[i], p.seen, p.seen});
    }
    follower.update(judged);
    finder.learn(judged);
    stated_px = std::sqrt(stated / static_cast<double>(points.keyframe.size()));
    return std::sqrt(sum / (2.0 * static_cast<double>(points.keyframe.size())));
  }
  double stated_px = 0.0;
};

// Templates that are only shifted have an error of about 1 px per unit of magnification: 0.015 px at the first two
// steps.
TEST(RegionDeformation, PointsOfADeformedImageAreWhereTheyAreAndTheirSigmaHolds) {
  Rig rig;
  const double still = rig.error({{}, {0.3, -0.2}}), stated = rig.stated_px;
  EXPECT_LT(still, 0.01);
  for (const Deformation& a : {Deformation{0.01, 0.0, 0.0, 0.01},
                               {0.02, 0.0, 0.0, 0.02},
                               {-0.015, 0.0, 0.0, -0.015},
                               {0.0, -0.015, 0.015, 0.0},
                               {0.0, 0.01, 0.0, 0.004}}) {
    EXPECT_LT(rig.error({a, {0.6, 0.4}}), 1.15 * still) << a.uu << " " << a.uv;
    EXPECT_NEAR(rig.stated_px / stated, 1.0, 0.12) << a.uu << " " << a.uv;
  }
}

std::vector<KltPoint> moved(const Points& points, const Motion& motion, double sigma_px) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, sigma_px);
  std::vector<KltPoint> found;
  for (const Vector2& x : points.keyframe) {
    KltPoint& point = found.emplace_back();
    const Vector2 at = motion.of(x);
    point.position = {at.u + noise(random), at.v + noise(random)};
    point.sigma_px = sigma_px;
    point.seen = true;
  }
  return found;
}

void expect_near(const Deformation& a, const Deformation& b, double limit) {
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(a.elements()[k], b.elements()[k], limit) << k;
}

TEST(RegionDeformation, IsThatOfItsPoints) {
  const Points points;
  RegionDeformation deformation(points.keyframe, points.region, 2);
  const Deformation a{0.02, -0.004, 0.003, 0.01};
  deformation.update(moved(points, {a, {3.0, -2.0}}, 0.02));
  for (std::size_t r = 0; r < 2; ++r) expect_near(deformation.of(r), a, 5e-4);
}

TEST(RegionDeformation, PointsThatWentElsewhereTakeNoPart) {
  const Points points;
  RegionDeformation deformation(points.keyframe, points.region, 2);
  const Deformation a{0.01, 0.0, 0.0, 0.01};
  std::vector<KltPoint> found = moved(points, {a, {}}, 0.02);
  found[0].position.u += 2.5, found[19].position.v -= 2.0;  // at opposite corners of the first region
  TrackFrame judged;
  for (std::size_t i = 0; i < found.size(); ++i) judged.points.push_back({0, 0, 0, 0, 0, true, i != 25});
  found[25].position.u += 400.0;  // an outlier in the image before
  deformation.learn(judged);
  deformation.update(found);
  for (std::size_t r = 0; r < 2; ++r) expect_near(deformation.of(r), a, 1e-3);
}

// Three points on a line give no information across it: the other region does.
TEST(RegionDeformation, FewPointsFollowTheOthers) {
  const Points points;
  RegionDeformation deformation(points.keyframe, points.region, 2);
  const Deformation a{0.015, 0.0, 0.0, 0.015};
  std::vector<KltPoint> found = moved(points, {a, {}}, 0.02);
  for (std::size_t i = 3; i < 20; ++i) found[i].seen = false, found[i].position = {NAN, NAN};
  deformation.update(found);
  expect_near(deformation.of(0), a, 1e-3);
  for (KltPoint& point : found) point.seen = false;
  deformation.update(found);
  expect_near(deformation.of(0), {}, 1e-12);
}

}  // namespace
}  // namespace core
