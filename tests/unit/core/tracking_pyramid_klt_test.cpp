#include "core/tracking/pyramid_klt.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/tracking/point_seeder.h"
#include "tests/support/analytic_texture.h"

namespace core {
namespace {

using test_support::AnalyticTexture;
constexpr int kWidth = 240;
constexpr int kHeight = 180;

std::vector<cv::Point2f> seed(const cv::Mat& gray, double border_px = 30.0) {
  SeedConfig config;
  config.points_per_region = 25;
  const Region region{
      "r", border_px, border_px, kWidth - 2 * border_px, kHeight - 2 * border_px, RegionRole::kStructure, 0.0, false};
  return seed_points(gray, region, config);
}

struct Fixture {
  AnalyticTexture texture{11};
  cv::Mat keyframe = texture.image(kWidth, kHeight, 0.0, 0.0);
  std::vector<cv::Point2f> points = seed(keyframe);
  PyramidKlt tracker{PyramidKltConfig{}};
  std::vector<TrackedPoint> out;

  Fixture() { tracker.set_keyframe(keyframe, points); }
};

// rms over points and axes of the error against the true shift; every point must be seen.
double rms_error(const std::vector<TrackedPoint>& tracked, const std::vector<cv::Point2f>& points, double du,
                 double dv) {
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_TRUE(tracked[i].seen) << "point " << i;
    const double eu = static_cast<double>(tracked[i].position.x) - static_cast<double>(points[i].x) - du;
    const double ev = static_cast<double>(tracked[i].position.y) - static_cast<double>(points[i].y) - dv;
    sum += eu * eu + ev * ev;
  }
  return std::sqrt(sum / (2.0 * static_cast<double>(points.size())));
}

TEST(PyramidKlt, MeasuresSubPixelShifts) {
  Fixture f;
  ASSERT_EQ(f.points.size(), 25U);
  double worst = 0.0;
  for (int k = 0; k < 12; ++k) {
    const double du = 0.1 * k - 0.37;
    const double dv = 0.61 - 0.13 * k;
    ASSERT_TRUE(f.tracker.track(f.texture.image(kWidth, kHeight, du, dv), f.points, f.out));
    worst = std::max(worst, rms_error(f.out, f.points, du, dv));
  }
  EXPECT_LT(worst, 0.02);
  RecordProperty("worst_rms_px", std::to_string(worst));
}

TEST(PyramidKlt, AnUnchangedImageHasNoMotion) {
  Fixture f;
  ASSERT_TRUE(f.tracker.track(f.keyframe, f.points, f.out));
  EXPECT_LT(rms_error(f.out, f.points, 0.0, 0.0), 1e-3);
}

TEST(PyramidKlt, FollowsLargeShiftsThroughThePyramid) {
  AnalyticTexture coarse(12, 16.0);
  const cv::Mat keyframe = coarse.image(kWidth, kHeight, 0.0, 0.0);
  const std::vector<cv::Point2f> points = seed(keyframe, 50.0);
  PyramidKlt tracker{PyramidKltConfig{}};
  tracker.set_keyframe(keyframe, points);
  std::vector<TrackedPoint> out;
  ASSERT_TRUE(tracker.track(coarse.image(kWidth, kHeight, 17.3, -11.6), points, out));
  EXPECT_LT(rms_error(out, points, 17.3, -11.6), 0.02);
}

TEST(PyramidKlt, StartsFromThePrediction) {
  Fixture f;
  std::vector<cv::Point2f> predicted = f.points;
  for (cv::Point2f& p : predicted) p += cv::Point2f(14.0F, 9.0F);
  ASSERT_TRUE(f.tracker.track(f.texture.image(kWidth, kHeight, 14.4, 8.7), predicted, f.out));
  EXPECT_LT(rms_error(f.out, f.points, 14.4, 8.7), 0.02);
}

TEST(PyramidKlt, APointWhosePatchWasReplacedIsLostAndTheOthersAreNot) {
  Fixture f;
  cv::Mat image = f.texture.image(kWidth, kHeight, 0.4, 0.2);
  const cv::Point2f hidden = f.points[7];
  const cv::Rect cover =
      cv::Rect(cvRound(hidden.x) - 16, cvRound(hidden.y) - 16, 33, 33) & cv::Rect(0, 0, kWidth, kHeight);
  AnalyticTexture(99).image(kWidth, kHeight, 0.0, 0.0)(cover).copyTo(image(cover));
  ASSERT_TRUE(f.tracker.track(image, f.points, f.out));
  EXPECT_FALSE(f.out[7].seen);
  int n_far_seen = 0;
  int n_far = 0;
  for (std::size_t i = 0; i < f.points.size(); ++i) {
    const cv::Point2f away = f.points[i] - hidden;
    if (std::abs(away.x) < 28.0F && std::abs(away.y) < 28.0F) continue;
    ++n_far;
    n_far_seen += f.out[i].seen ? 1 : 0;
  }
  EXPECT_GT(n_far, 10);
  EXPECT_EQ(n_far_seen, n_far);
}

TEST(PyramidKlt, NothingIsSeenInABlankImage) {
  Fixture f;
  ASSERT_TRUE(f.tracker.track(cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(128)), f.points, f.out));
  for (const TrackedPoint& point : f.out) EXPECT_FALSE(point.seen);
}

// A point whose window extends beyond the border would be compared with pixels that do not exist.
TEST(PyramidKlt, APointThatLeavesTheImageIsLost) {
  Fixture f;
  const double du = -60.0;
  std::vector<cv::Point2f> predicted = f.points;
  for (cv::Point2f& p : predicted) p.x += static_cast<float>(du);
  ASSERT_TRUE(f.tracker.track(f.texture.image(kWidth, kHeight, du, 0.0), predicted, f.out));
  int n_outside = 0;
  for (std::size_t i = 0; i < f.points.size(); ++i) {
    const double u = static_cast<double>(f.points[i].x) + du;
    if (u < 0.0) {
      ++n_outside;
      EXPECT_FALSE(f.out[i].seen) << "at " << u;
    } else if (f.out[i].seen) {
      EXPECT_NEAR(static_cast<double>(f.out[i].position.x), u, 0.1) << "seen at " << u << ", so it must be right";
    }
  }
  EXPECT_GT(n_outside, 0);
}

TEST(PyramidKlt, AnImageOfAnotherKindIsAFailureNotACrash) {
  Fixture f;
  for (const cv::Mat& image : {cv::Mat(), cv::Mat(kHeight, kWidth, CV_32FC1, cv::Scalar(0)),
                               f.keyframe(cv::Rect(0, 0, 200, 100)), cv::Mat(1, 1, CV_8UC1, cv::Scalar(0))}) {
    EXPECT_FALSE(f.tracker.track(image, f.points, f.out));
  }
  EXPECT_TRUE(f.tracker.track(f.keyframe, f.points, f.out)) << "and the next good image is tracked again";
  EXPECT_LT(rms_error(f.out, f.points, 0.0, 0.0), 1e-3);
}

TEST(PyramidKlt, WithoutPointsThereIsNothingToDo) {
  Fixture f;
  f.tracker.set_keyframe(f.keyframe, {});
  EXPECT_TRUE(f.tracker.track(f.keyframe, {}, f.out));
  EXPECT_TRUE(f.out.empty());
}

// Independent noise in keyframe and image: the error against the truth is that of the difference of two noisy images.
TEST(PyramidKlt, StatedSigmaIsTheScatter) {
  const AnalyticTexture texture(21);
  for (const double noise : {2.0, 6.0}) {
    double error2 = 0.0;
    double sigma2 = 0.0;
    int n = 0;
    for (unsigned trial = 0; trial < 12; ++trial) {
      const cv::Mat keyframe = texture.image(kWidth, kHeight, 0.0, 0.0, noise, 2 * trial + 1);
      const std::vector<cv::Point2f> points = seed(keyframe);
      PyramidKlt tracker{PyramidKltConfig{}};
      tracker.set_keyframe(keyframe, points);
      std::vector<TrackedPoint> out;
      const double du = 0.3 + 0.05 * trial;
      ASSERT_TRUE(tracker.track(texture.image(kWidth, kHeight, du, -0.4, noise, 2 * trial + 2), points, out));
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (!out[i].seen) continue;
        const double eu = static_cast<double>(out[i].position.x - points[i].x) - du;
        const double ev = static_cast<double>(out[i].position.y - points[i].y) + 0.4;
        error2 += 0.5 * (eu * eu + ev * ev);
        sigma2 += out[i].sigma_px * out[i].sigma_px;
        ++n;
      }
    }
    ASSERT_GT(n, 200);
    const double ratio = std::sqrt(sigma2 / error2);
    EXPECT_GT(ratio, 1.0 / 1.5) << "noise " << noise << ": error " << std::sqrt(error2 / n);
    EXPECT_LT(ratio, 1.5) << "noise " << noise << ": error " << std::sqrt(error2 / n);
    RecordProperty("sigma_over_error_at_noise_" + std::to_string(static_cast<int>(noise)), std::to_string(ratio));
  }
}

}  // namespace
}  // namespace core
