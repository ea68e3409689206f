#include "core/tracking/point_finder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/analytic_texture.h"
#include "tests/support/gray_view.h"

namespace core {
namespace {

using test_support::AnalyticTexture;
using test_support::view;
constexpr int kWidth = 480, kHeight = 320;
constexpr std::size_t kRegions = 2, kPerRegion = 12;

struct Rig {
  AnalyticTexture texture{31};
  std::vector<Vector2> keyframe;
  std::vector<std::uint16_t> region;
  std::unique_ptr<RegionFollower> follower;
  std::unique_ptr<PointFinder> finder;

  Rig() {
    for (std::size_t r = 0; r < kRegions; ++r) {
      for (std::size_t k = 0; k < kPerRegion; ++k) {
        keyframe.push_back({160.0 + 14.0 * static_cast<double>(k % 6),
                            110.0 + 90.0 * static_cast<double>(r) + 14.0 * static_cast<double>(k / 6)});
        region.push_back(static_cast<std::uint16_t>(r));
      }
    }
    follower = std::make_unique<RegionFollower>(RegionFollowerConfig{kWidth, kHeight}, keyframe, region, kRegions);
    finder = std::make_unique<PointFinder>(PointFinderConfig{}, view(image(0.0, 0.0)), keyframe, region, kRegions);
  }
  [[nodiscard]] cv::Mat image(double du, double dv) const { return texture.image(kWidth, kHeight, du, dv, 1.0, 3); }

  // Number of a region's points within a tenth of a px of the truth.
  [[nodiscard]] int n_right(std::size_t r, double du, double dv) const {
    int n = 0;
    for (std::size_t i = r * kPerRegion; i < (r + 1) * kPerRegion; ++i) {
      const KltPoint& p = finder->points()[i];
      n += p.seen && std::hypot(p.position.u - keyframe[i].u - du, p.position.v - keyframe[i].v - dv) < 0.15;
    }
    return n;
  }
  void learn() {
    TrackFrame judged;
    for (std::size_t i = 0; i < keyframe.size(); ++i) {
      const KltPoint& p = finder->points()[i];
      judged.points.push_back({p.position.u, p.position.v, p.sigma_px, 0, region[i], p.seen, p.seen});
    }
    follower->update(judged);
    finder->learn(judged);
  }
};

TEST(PointFinder, FindsRegionsThatJumped) {
  Rig rig;
  rig.finder->find(view(rig.image(0.0, 0.0)), *rig.follower);
  rig.learn();
  for (const auto& [du, dv] : {std::pair{61.3, -40.6}, {-97.2, 20.4}, {4.4, 3.1}}) {
    rig.finder->find(view(rig.image(du, dv)), *rig.follower);
    for (std::size_t r = 0; r < kRegions; ++r) EXPECT_EQ(rig.n_right(r, du, dv), static_cast<int>(kPerRegion)) << du;
  }
}

TEST(PointFinder, ARegionThatIsCoveredIsNotSeenAndTheOtherIs) {
  Rig rig;
  rig.finder->find(view(rig.image(0.0, 0.0)), *rig.follower);
  rig.learn();
  cv::Mat covered = rig.image(0.3, 0.2);
  covered(cv::Rect(0, 170, kWidth, 150)).setTo(90);
  rig.finder->find(view(covered), *rig.follower);
  EXPECT_EQ(rig.n_right(0, 0.3, 0.2), static_cast<int>(kPerRegion));
  for (std::size_t i = kPerRegion; i < 2 * kPerRegion; ++i) EXPECT_FALSE(rig.finder->points()[i].seen) << i;
}

// A grating of 12 px period and a unique detail: half a period off, each point alone finds the next bar.
TEST(PointFinder, PointsThatSlippedToTheNextBarAreFoundOut) {
  Rig rig;
  const auto scene = [&](int du) {
    cv::Mat out(kHeight, kWidth, CV_8UC1);
    const cv::Mat texture = AnalyticTexture(8, 9.0, 9.0).image(kWidth, kHeight, du, 0.0, 1.0, 5);
    for (int v = 0; v < kHeight; ++v)
      for (int u = 0; u < kWidth; ++u)
        out.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(
            texture.at<std::uint8_t>(v, u) +
            60.0 * std::sin(2.0 * std::numbers::pi * (u - du) / 12.0) * std::cos(2.0 * std::numbers::pi * v / 12.0));
    return out;
  };
  rig.finder = std::make_unique<PointFinder>(PointFinderConfig{}, view(scene(0)), rig.keyframe, rig.region, kRegions);
  for (int k = 0; k < 3; ++k) {
    rig.finder->find(view(scene(0)), *rig.follower);
    rig.learn();
  }
  rig.finder->find(view(scene(11)), *rig.follower);
  for (std::size_t r = 0; r < kRegions; ++r) EXPECT_EQ(rig.n_right(r, 11.0, 0.0), static_cast<int>(kPerRegion)) << r;
}

// The edge lies in the windows of two points of each region, where gain and offset cannot describe the light.
TEST(PointFinder, PointsOnTheEdgeOfAShadowAreLeftOutAndComeBack) {
  Rig rig;
  const auto look_at = [&](double du, bool is_shaded) {
    cv::Mat image = rig.image(du, 0.0);
    if (is_shaded) image(cv::Rect(0, 0, 188, kHeight)) *= 0.7;
    rig.finder->find(view(image), *rig.follower);
    rig.learn();
  };
  for (int k = 0; k < 3; ++k) look_at(0.1 * k, false);
  look_at(0.4, true);
  for (std::size_t i = 0; i < rig.keyframe.size(); ++i)
    EXPECT_EQ(rig.finder->points()[i].seen, rig.keyframe[i].u != 188.0) << i;
  for (std::size_t r = 0; r < kRegions; ++r) EXPECT_EQ(rig.n_right(r, 0.4, 0.0), static_cast<int>(kPerRegion) - 2);
  look_at(0.5, false);
  for (std::size_t r = 0; r < kRegions; ++r) EXPECT_EQ(rig.n_right(r, 0.5, 0.0), static_cast<int>(kPerRegion));
}

TEST(PointFinder, NothingInADarkImage) {
  Rig rig;
  rig.finder->find(view(cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(0))), *rig.follower);
  for (const KltPoint& point : rig.finder->points()) EXPECT_FALSE(point.seen);
  rig.finder->find(view(rig.image(0.0, 0.0)), *rig.follower);
  EXPECT_EQ(rig.n_right(0, 0.0, 0.0), static_cast<int>(kPerRegion));
}

}  // namespace
}  // namespace core
