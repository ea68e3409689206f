#include "core/tracking/klt/klt_tracker.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/tracking/point_seeder.h"
#include "tests/support/analytic_texture.h"
#include "tests/support/gray_view.h"

namespace core {
namespace {

using test_support::AnalyticTexture;
using test_support::view;
constexpr int kWidth = 240;
constexpr int kHeight = 180;

std::vector<Vector2> seed(const cv::Mat& gray, double border_px = 30.0) {
  SeedConfig config;
  config.points_per_region = 25;
  const Region region{
      "r", border_px, border_px, kWidth - 2 * border_px, kHeight - 2 * border_px, RegionRole::kStructure, 0.0, false};
  std::vector<Vector2> points;
  for (const cv::Point2f& p : seed_points(gray, region, config)) points.push_back({p.x, p.y});
  return points;
}

struct Fixture {
  AnalyticTexture texture{11};
  cv::Mat keyframe = texture.image(kWidth, kHeight, 0.0, 0.0);
  std::vector<Vector2> points = seed(keyframe);
  KltTracker tracker{KltConfig{}};

  Fixture() { tracker.set_keyframe(view(keyframe), points); }

  std::vector<KltPoint> find(const cv::Mat& image, double du = 0.0, double dv = 0.0) {
    std::vector<KltPoint> out;
    for (std::size_t i = 0; i < points.size(); ++i)
      out.push_back(tracker.find(view(image), i, {points[i].u + du, points[i].v + dv}));
    return out;
  }
};

// rms over points and axes of the error against the true shift; every point must be seen.
double rms_error(const std::vector<KltPoint>& tracked, const std::vector<Vector2>& points, double du, double dv) {
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_TRUE(tracked[i].seen) << "point " << i;
    const double eu = tracked[i].position.u - points[i].u - du, ev = tracked[i].position.v - points[i].v - dv;
    sum += eu * eu + ev * ev;
  }
  return std::sqrt(sum / (2.0 * static_cast<double>(points.size())));
}

// Rounding to 8 bits alone leaves about 0.0015 px in this texture.
TEST(KltTracker, MeasuresSubPixelShifts) {
  Fixture f;
  ASSERT_EQ(f.points.size(), 25U);
  double worst = 0.0;
  for (int k = 0; k < 12; ++k) {
    const double du = 0.1 * k - 0.37, dv = 0.61 - 0.13 * k;
    worst = std::max(worst, rms_error(f.find(f.texture.image(kWidth, kHeight, du, dv)), f.points, du, dv));
  }
  EXPECT_LT(worst, 0.003);
  RecordProperty("worst_rms_px", std::to_string(worst));
}

TEST(KltTracker, AnUnchangedImageHasNoMotion) {
  Fixture f;
  EXPECT_LT(rms_error(f.find(f.keyframe), f.points, 0.0, 0.0), 1e-4);
}

TEST(KltTracker, StartsFromThePrediction) {
  Fixture f;
  EXPECT_LT(rms_error(f.find(f.texture.image(kWidth, kHeight, 14.4, 8.7), 14.0, 9.0), f.points, 14.4, 8.7), 0.003);
}

// Light that increases by a quarter and by a level causes no motion; both are distinguished from motion.
TEST(KltTracker, GainAndOffsetOfTheLightMoveNothing) {
  Fixture f;
  cv::Mat brighter;
  const AnalyticTexture dim(11, 8.0, 20.0);
  f.keyframe = dim.image(kWidth, kHeight, 0.0, 0.0);
  f.points = seed(f.keyframe);
  f.tracker.set_keyframe(view(f.keyframe), f.points);
  dim.image(kWidth, kHeight, 0.4, -0.3).convertTo(brighter, CV_8UC1, 1.25, -20.0);
  const auto found = f.find(brighter);
  EXPECT_LT(rms_error(found, f.points, 0.4, -0.3), 0.005);
  for (const KltPoint& point : found) EXPECT_NEAR(point.gain, 1.25, 0.03);
}

// From one image to the next: steps computed for the old light would be too long or too short.
TEST(KltTracker, ASuddenlyDarkerOrBrighterImageLosesNothing) {
  Fixture f;
  f.keyframe.convertTo(f.keyframe, -1, 0.6, 10.0);
  f.tracker.set_keyframe(view(f.keyframe), f.points);
  for (const double light : {1.0, 0.5, 1.4, 0.4, 1.0}) {
    cv::Mat image = f.texture.image(kWidth, kHeight, 2.6, -1.7);
    image.convertTo(image, -1, 0.6 * light, 10.0);
    EXPECT_LT(rms_error(f.find(image), f.points, 2.6, -1.7), 0.02) << light;
  }
}

TEST(KltTracker, APointWhosePatchWasReplacedIsLostAndTheOthersAreNot) {
  Fixture f;
  cv::Mat image = f.texture.image(kWidth, kHeight, 0.4, 0.2);
  const Vector2 hidden = f.points[7];
  const cv::Rect cover =
      cv::Rect(cvRound(hidden.u) - 16, cvRound(hidden.v) - 16, 33, 33) & cv::Rect(0, 0, kWidth, kHeight);
  AnalyticTexture(99).image(kWidth, kHeight, 0.0, 0.0)(cover).copyTo(image(cover));
  const auto found = f.find(image);
  EXPECT_FALSE(found[7].seen);
  int n_far_seen = 0, n_far = 0;
  for (std::size_t i = 0; i < f.points.size(); ++i) {
    if (std::abs(f.points[i].u - hidden.u) < 28.0 && std::abs(f.points[i].v - hidden.v) < 28.0) continue;
    ++n_far;
    n_far_seen += found[i].seen ? 1 : 0;
  }
  EXPECT_GT(n_far, 10);
  EXPECT_EQ(n_far_seen, n_far);
}

TEST(KltTracker, NothingIsSeenInABlankImage) {
  Fixture f;
  for (const KltPoint& point : f.find(cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(128)))) EXPECT_FALSE(point.seen);
}

// A point whose window extends beyond the border would be compared with pixels that do not exist.
TEST(KltTracker, APointThatLeavesTheImageIsLost) {
  Fixture f;
  const double du = -60.0;
  const auto found = f.find(f.texture.image(kWidth, kHeight, du, 0.0), du, 0.0);
  int n_outside = 0;
  for (std::size_t i = 0; i < f.points.size(); ++i) {
    const double u = f.points[i].u + du;
    if (u < 0.0) {
      ++n_outside;
      EXPECT_FALSE(found[i].seen) << "at " << u;
    } else if (found[i].seen) {
      EXPECT_NEAR(found[i].position.u, u, 0.02) << "seen at " << u << ", so it must be right";
    }
  }
  EXPECT_GT(n_outside, 0);
}

TEST(KltTracker, ImagesOfAnotherKindAndWildPredictionsLosePointsAndNothingElse) {
  Fixture f;
  const double nan = std::nan("");
  for (const cv::Mat& image : {cv::Mat(), cv::Mat(kHeight, kWidth, CV_32FC1, cv::Scalar(0)),
                               f.keyframe(cv::Rect(0, 0, 20, 10)), cv::Mat(1, 1, CV_8UC1, cv::Scalar(0))}) {
    for (const KltPoint& point : f.find(image)) EXPECT_FALSE(point.seen);
  }
  for (const Vector2& wild : {Vector2{nan, 3.0}, Vector2{1e300, 0.0}, Vector2{0.0, -1e9}, Vector2{-HUGE_VAL, nan}})
    EXPECT_FALSE(f.tracker.find(view(f.keyframe), 0, wild).seen);
  EXPECT_LT(rms_error(f.find(f.keyframe), f.points, 0.0, 0.0), 1e-4);
  EXPECT_THROW(f.tracker.set_keyframe(view(cv::Mat()), {}), std::invalid_argument);
  EXPECT_THROW(KltTracker(KltConfig{31}).set_keyframe(view(f.keyframe), f.points), std::invalid_argument);
}

// A patch with gradients in one direction only gives no information about the other.
TEST(KltTracker, AnEdgeOrAFlatPatchIsNoPoint) {
  cv::Mat edge(kHeight, kWidth, CV_8UC1, cv::Scalar(40));
  edge.colRange(100, kWidth).setTo(200);
  KltTracker tracker{KltConfig{}};
  tracker.set_keyframe(view(edge), {{100.0, 90.0}, {40.0, 40.0}});
  EXPECT_FALSE(tracker.find(view(edge), 0, {100.0, 90.0}).seen);
  EXPECT_FALSE(tracker.find(view(edge), 1, {40.0, 40.0}).seen);
}

// Over many images against one template, about each point's own mean: METHOD section 2.
TEST(KltTracker, StatedSigmaIsTheScatterAgainstATemplate) {
  const AnalyticTexture texture(21);
  for (const double noise : {2.0, 6.0}) {
    const cv::Mat keyframe = texture.image(kWidth, kHeight, 0.0, 0.0, noise, 1);
    Fixture f;
    f.points = seed(keyframe);
    f.tracker.set_keyframe(view(keyframe), f.points);
    constexpr int kImages = 16;
    std::vector<std::vector<KltPoint>> found;
    for (unsigned k = 0; k < kImages; ++k)
      found.push_back(f.find(texture.image(kWidth, kHeight, 0.3 + 0.05 * k, -0.4, noise, k + 2)));
    double scatter2 = 0.0, sigma2 = 0.0;
    for (std::size_t i = 0; i < f.points.size(); ++i) {
      double mean = 0.0, square = 0.0;
      for (unsigned k = 0; k < kImages; ++k) {
        EXPECT_TRUE(found[k][i].seen);
        const double error = found[k][i].position.u - f.points[i].u - 0.3 - 0.05 * k;
        mean += error / kImages;
        square += error * error / kImages;
        sigma2 += found[k][i].sigma_px * found[k][i].sigma_px / kImages;
      }
      scatter2 += (square - mean * mean) * kImages / (kImages - 1.0);
    }
    EXPECT_NEAR(std::sqrt(sigma2 / scatter2), 1.0, 0.15) << "noise " << noise;
  }
}

}  // namespace
}  // namespace core
