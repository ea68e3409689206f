#include "core/tracking/region_survey.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace {

constexpr int kWidth = 480, kHeight = 320, kFrames = 60;

cv::Mat texture(int width, int height, std::uint64_t seed) {
  cv::RNG random(seed);
  cv::Mat noise(height, width, CV_8UC1);
  random.fill(noise, cv::RNG::UNIFORM, 0, 256);
  cv::Mat smooth;
  cv::GaussianBlur(noise, smooth, {0, 0}, 2.0);
  cv::normalize(smooth, smooth, 20, 235, cv::NORM_MINMAX);
  return smooth;
}

// Whole pixels: up to 60 from one frame to the next, ten times the search range of a point.
int moved_px(int frame) {
  return static_cast<int>(std::lround(80.0 * std::sin(2.0 * std::numbers::pi * 3.0 * frame / 25.0)));
}

TEST(RegionSurvey, FollowsAPlateThatMovesByFarMoreThanItsCornersAreSearchedFor) {
  const cv::Mat wall = texture(kWidth, kHeight, 1), plate = texture(150, 110, 2);
  std::vector<core::SurveyedPoint> points;
  std::size_t n_corners = 0;
  std::optional<core::RegionSurvey> survey;
  for (int k = 0; k < kFrames; ++k) {
    cv::Mat image = wall.clone();
    plate.copyTo(image({165 + moved_px(k), 100, plate.cols, plate.rows}));
    const core::GrayView view{image.data, kWidth, kHeight, kWidth};
    if (k == 0) {
      survey.emplace(view, core::RegionSurveyConfig{});
    } else {
      survey->add(view);
    }
  }
  n_corners = survey->n_corners();
  points = survey->take_points();
  const auto is_on_plate = [](const core::SurveyedPoint& point) {
    return point.at.u > 180.0 && point.at.u < 300.0 && point.at.v > 115.0 && point.at.v < 195.0;
  };
  std::size_t n_followed = 0, n_at_rest = 0;
  for (const core::SurveyedPoint& point : points) {
    double worst_plate = 0.0, worst_wall = 0.0;
    for (int k = 0; k < kFrames; ++k) {
      const core::Vector2& m = point.motion[static_cast<std::size_t>(k)];
      worst_plate = std::max(worst_plate, std::hypot(m.u - moved_px(k), m.v));
      worst_wall = std::max(worst_wall, std::hypot(m.u, m.v));
    }
    if (is_on_plate(point) && worst_plate < 0.2) ++n_followed;
    if (!is_on_plate(point) && worst_wall < 0.2) ++n_at_rest;
  }
  EXPECT_GE(n_followed, 10U) << "of " << n_corners << " corners, " << points.size() << " kept";
  EXPECT_GE(n_at_rest, 50U);
}

}  // namespace
