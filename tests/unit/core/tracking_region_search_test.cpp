#include "core/tracking/region_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/analytic_texture.h"
#include "tests/support/gray_view.h"

namespace core {
namespace {

using test_support::AnalyticTexture;
using test_support::view;
constexpr int kWidth = 640, kHeight = 360;

const std::vector<Vector2>& points() {
  static const std::vector<Vector2> kPoints{{250.0, 150.0}, {390.0, 150.0}, {250.0, 200.0}, {390.0, 200.0}};
  return kPoints;
}

TEST(RegionSearch, FindsALargeJump) {
  const AnalyticTexture texture(5, 12.0);
  RegionSearch search(view(texture.image(kWidth, kHeight, 0.0, 0.0)), points(), 200.0);
  for (const auto& [du, dv] : {std::pair{120.0, -40.0}, {-171.0, 90.0}, {3.0, 2.0}, {199.0, -110.0}}) {
    const auto found = search.find(view(texture.image(kWidth, kHeight, du, dv)), {});
    EXPECT_TRUE(found.is_clear) << du << ", " << dv;
    EXPECT_NEAR(found.motion.u, du, 2.0);
    EXPECT_NEAR(found.motion.v, dv, 2.0);
  }
}

// Equal dots in a row: the whole row, with its ends, determines the assignment.
TEST(RegionSearch, ARowOfEqualDotsIsNotMovedByOneDot) {
  const auto dots = [](int du) {
    cv::Mat image(kHeight, kWidth, CV_8UC1, cv::Scalar(220));
    for (int k = 0; k < 5; ++k) {
      for (int y = -6; y <= 6; ++y)
        for (int x = -6; x <= 6; ++x)
          if (x * x + y * y <= 36) image.at<std::uint8_t>(180 + y, 200 + 40 * k + du + x) = 30;
    }
    return image;
  };
  std::vector<Vector2> row;
  for (int k = 0; k < 5; ++k) row.push_back({200.0 + 40.0 * k, 180.0});
  RegionSearch search(view(dots(0)), row, 150.0);
  for (const int du : {55, 104, -97}) {
    const auto found = search.find(view(dots(du)), {});
    EXPECT_TRUE(found.is_clear) << du;
    EXPECT_NEAR(found.motion.u, du, 2.0);
    EXPECT_NEAR(found.motion.v, 0.0, 2.0);
  }
}

TEST(RegionSearch, WhatIsNotThereIsNotFound) {
  const AnalyticTexture texture(5, 12.0);
  RegionSearch search(view(texture.image(kWidth, kHeight, 0.0, 0.0)), points(), 100.0);
  EXPECT_FALSE(search.find(view(AnalyticTexture(77, 12.0).image(kWidth, kHeight, 0.0, 0.0)), {}).is_clear);
  EXPECT_FALSE(search.find(view(cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(7))), {}).is_clear);
  EXPECT_FALSE(search.find(view(cv::Mat()), {}).is_clear);
  EXPECT_FALSE(search.find(view(texture.image(kWidth, kHeight, 0.0, 0.0)), {std::nan(""), 0.0}).is_clear);
  EXPECT_FALSE(search.find(view(texture.image(kWidth, kHeight, 0.0, 0.0)), {1e18, -1e18}).is_clear);
}

TEST(RegionSearch, ARegionWithoutPointsIsNeverFound) {
  RegionSearch search(view(cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(7))), {}, 100.0);
  EXPECT_FALSE(search.find(view(cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(7))), {}).is_clear);
}

}  // namespace
}  // namespace core
