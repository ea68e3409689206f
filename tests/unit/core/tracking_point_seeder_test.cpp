#include "core/tracking/point_seeder.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/analytic_texture.h"

namespace core {
namespace {

using test_support::AnalyticTexture;

Region rect(double u, double v, double width, double height) {
  return {"r", u, v, width, height, RegionRole::kStructure, 0.0, false};
}

TEST(PointSeeder, KeepsToTheRegionTheCountAndTheDistance) {
  const cv::Mat gray = AnalyticTexture(1).image(320, 240, 0.0, 0.0);
  SeedConfig config;
  config.points_per_region = 12;
  config.min_distance_px = 10.0;
  const std::vector<cv::Point2f> points = seed_points(gray, rect(60, 50, 120, 90), config);
  ASSERT_EQ(points.size(), 12U);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_TRUE(points[i].x >= 60.0F && points[i].x < 180.0F && points[i].y >= 50.0F && points[i].y < 140.0F);
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE(cv::norm(points[i] - points[j]), 10.0);
  }
}

TEST(PointSeeder, FindsTheCornersOfASquare) {
  cv::Mat gray(100, 100, CV_8UC1, cv::Scalar(40));
  gray(cv::Rect(35, 40, 30, 20)).setTo(200);
  SeedConfig config;
  config.corner_quality = 0.2;
  const std::vector<cv::Point2f> points = seed_points(gray, rect(0, 0, 100, 100), config);
  ASSERT_EQ(points.size(), 4U);
  for (const cv::Point2f& p : points) {
    EXPECT_LT(std::min(std::abs(p.x - 34.5F), std::abs(p.x - 64.5F)), 2.5F);
    EXPECT_LT(std::min(std::abs(p.y - 39.5F), std::abs(p.y - 59.5F)), 2.5F);
  }
}

TEST(PointSeeder, KeepsItsWindowInsideTheImage) {
  const cv::Mat gray = AnalyticTexture(2).image(160, 120, 0.0, 0.0);
  SeedConfig config;
  config.points_per_region = 200;
  config.min_distance_px = 2.0;
  const std::vector<cv::Point2f> points = seed_points(gray, rect(-50, -50, 400, 400), config);
  ASSERT_GT(points.size(), 10U);
  for (const cv::Point2f& p : points) EXPECT_TRUE(p.x >= 10.0F && p.x <= 149.0F && p.y >= 10.0F && p.y <= 109.0F) << p;
}

TEST(PointSeeder, FindsNothingWhereThereIsNothing) {
  const SeedConfig config;
  EXPECT_TRUE(seed_points(cv::Mat::zeros(200, 200, CV_8UC1), rect(20, 20, 100, 100), config).empty()) << "black";
  EXPECT_TRUE(seed_points(cv::Mat(200, 200, CV_8UC1, cv::Scalar(255)), rect(20, 20, 100, 100), config).empty())
      << "saturated";
  const cv::Mat gray = AnalyticTexture(3).image(200, 200, 0.0, 0.0);
  EXPECT_TRUE(seed_points(gray, rect(300, 300, 50, 50), config).empty()) << "outside";
  EXPECT_TRUE(seed_points(gray, rect(50, 50, 1, 1), config).empty()) << "smaller than a corner";
  EXPECT_TRUE(seed_points(gray(cv::Rect(0, 0, 1, 1)), rect(0, 0, 1, 1), config).empty()) << "an image of one pixel";
  EXPECT_TRUE(seed_points(cv::Mat(), rect(0, 0, 10, 10), config).empty()) << "no image";
}

TEST(PointSeeder, GivesTheSamePointsAgain) {
  const cv::Mat gray = AnalyticTexture(4).image(200, 150, 0.0, 0.0);
  EXPECT_EQ(seed_points(gray, rect(0, 0, 200, 150), {}), seed_points(gray, rect(0, 0, 200, 150), {}));
}

}  // namespace
}  // namespace core
