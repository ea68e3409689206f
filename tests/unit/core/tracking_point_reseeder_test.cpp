#include "core/tracking/point_reseeder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "core/tracking/structure_tracker.h"
#include "tests/support/analytic_texture.h"

namespace core {
namespace {

using test_support::AnalyticTexture;

constexpr int kWidth = 200, kHeight = 90, kAfter = 8, kHalf = 15;
constexpr std::size_t kCovered = 2;  // the point that is covered

double sway(int k) { return 3.0 * std::sin(0.31 * k) + 1.3 * std::sin(1.7 * k); }

const AnalyticTexture& wall() {
  static const AnalyticTexture texture(41, 8.0, 30.0);
  return texture;
}

// The swaying wall, and from frame 10 on an object over 31 x 31 px about one of its points.
class Scene {
 public:
  // The object moves by shift(k); its appearance.
  Scene(std::function<double(int)> shift, const AnalyticTexture& cover, int first = 10)
      : shift_(std::move(shift)), cover_(cover), first_(first) {
    StructureTrackerConfig config;
    config.seed.points_per_region = 8;
    config.reseed_after = kAfter;
    config.regions = {{"wall", 25, 20, 150, 50, RegionRole::kStructure, 0.0, false}};
    tracker_ = std::make_unique<StructureTracker>(config);
    EXPECT_EQ(tracker_->seed(frame(0)), "");
    keyframe.points.resize(tracker_->n_points());
    tracks.points.resize(tracker_->n_points());
    EXPECT_TRUE(tracker_->track(frame(0), keyframe));
  }

  void go_on() {
    ++k;
    EXPECT_TRUE(tracker_->track(frame(k), tracks));
    for (TrackPoint& point : tracks.points)  // instead of the outlier rejection
      point.inlier = point.seen && std::abs(error(point)) < 1.0;
    tracker_->learn(tracks);
  }
  [[nodiscard]] double error(const TrackPoint& point) const {
    return point.u_px - keyframe.points[point.id].u_px - sway(k);
  }
  // Far enough from the covered point.
  [[nodiscard]] bool is_free(const TrackPoint& point) const {
    const TrackPoint &at = keyframe.points[point.id], &covered = keyframe.points[kCovered];
    return std::max(std::abs(at.u_px - covered.u_px), std::abs(at.v_px - covered.v_px)) > kHalf + 20.0;
  }
  [[nodiscard]] std::uint32_t n_reseeded() const { return tracker_->n_reseeded(); }

  int k = 0;
  TrackFrame keyframe, tracks;

 private:
  [[nodiscard]] Frame frame(int at) const {
    cv::Mat gray = wall().image(kWidth, kHeight, sway(at), 0.0, 1.0, static_cast<unsigned>(at + 1));
    if (at >= first_) {
      const TrackPoint& point = keyframe.points[kCovered];
      const int u0 = cvRound(point.u_px + shift_(at)), v0 = cvRound(point.v_px);
      for (int v = std::max(0, v0 - kHalf); v <= std::min(kHeight - 1, v0 + kHalf); ++v)
        for (int u = std::max(0, u0 - kHalf); u <= std::min(kWidth - 1, u0 + kHalf); ++u)
          gray.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(cover_.at(u - shift_(at), v));
    }
    Frame out;
    out.sequence = static_cast<std::uint64_t>(at);
    out.t_start_ns = at * 40'000'000LL;
    out.width_px = kWidth;
    out.height_px = kHeight;
    out.pixels.assign(gray.datastart, gray.dataend);
    return out;
  }

  std::function<double(int)> shift_;
  const AnalyticTexture& cover_;
  int first_;
  std::unique_ptr<StructureTracker> tracker_;
};

TEST(PointReseeder, WhatIsThenAtItsPlaceIsTrackedWithTheDatumKept) {
  const AnalyticTexture sign(42, 8.0, 30.0);
  Scene scene(sway, sign);
  while (scene.k < 10 + kAfter + PointReseeder::kTrialFrames - 2) {
    scene.go_on();
    EXPECT_EQ(scene.tracks.points[kCovered].seen, scene.k < 10) << scene.k;
  }
  double sum = 0.0;
  int n = 0;
  while (n < 60 && scene.k < 250) {
    scene.go_on();
    if (scene.tracks.points[kCovered].seen) sum += scene.error(scene.tracks.points[kCovered]), ++n;
  }
  EXPECT_EQ(n, 60);
  EXPECT_GE(scene.n_reseeded(), 1U);
  EXPECT_NEAR(sum / n, 0.0, 0.03);
}

TEST(PointReseeder, WhatDoesNotGoWithTheRegionIsNeverReadmitted) {
  const AnalyticTexture wire(43, 8.0, 30.0);
  for (const double share : {0.0, 0.8}) {  // static; nearly the same motion
    Scene scene([&](int k) { return share * sway(k); }, wire);
    while (scene.k < 10) scene.go_on();
    while (scene.k < 200) {
      scene.go_on();
      EXPECT_FALSE(scene.tracks.points[kCovered].seen) << scene.k;
    }
  }
}

TEST(PointReseeder, APointThatIsHiddenForAWhileComesBackAsItself) {
  const AnalyticTexture bird(44, 8.0, 30.0);
  // Moves away before the point is given up.
  Scene scene([](int k) { return sway(k) + (k < 10 + kAfter - 3 ? 0.0 : 1000.0); }, bird);
  while (scene.k < 60) scene.go_on();
  EXPECT_TRUE(scene.tracks.points[kCovered].seen);
  EXPECT_NEAR(scene.error(scene.tracks.points[kCovered]), 0.0, 0.1);
  EXPECT_EQ(scene.n_reseeded(), 0U);
}

TEST(PointReseeder, NothingToTrackThereSpoilsNoOther) {
  const AnalyticTexture fog(45, 8.0, 0.0);
  Scene scene(sway, fog);
  while (scene.k < 120) {
    scene.go_on();
    for (const TrackPoint& point : scene.tracks.points) {
      EXPECT_TRUE(point.inlier || !scene.is_free(point)) << point.id;
      EXPECT_TRUE(!point.seen || std::abs(scene.error(point)) < 0.3) << point.id << " at " << scene.k;
    }
  }
}

}  // namespace
}  // namespace core
