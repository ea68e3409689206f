#include "core/tracking/structure_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/analytic_texture.h"

namespace core {
namespace {

using test_support::AnalyticTexture;
constexpr int kWidth = 240;
constexpr int kHeight = 200;

Frame frame_of(const cv::Mat& gray, std::uint64_t sequence) {
  Frame frame;
  frame.sequence = sequence;
  frame.t_start_ns = static_cast<std::int64_t>(sequence) * 40'000'000;
  frame.gap_before = sequence == 3;
  frame.width_px = gray.cols;
  frame.height_px = gray.rows;
  frame.pixels.assign(gray.datastart, gray.dataend);
  return frame;
}

// Two plates, upper and lower half of the image, each with a texture of its own.
cv::Mat plates(double upper_du, double lower_du) {
  static const AnalyticTexture upper(31), lower(32);
  cv::Mat gray = upper.image(kWidth, kHeight, upper_du, 0.0);
  const cv::Rect half(0, kHeight / 2, kWidth, kHeight / 2);
  lower.image(kWidth, kHeight, lower_du, 0.0)(half).copyTo(gray(half));
  return gray;
}

StructureTrackerConfig config() {
  StructureTrackerConfig c;
  c.seed.points_per_region = 10;
  c.regions = {{"roof", 40, 15, 160, 70, RegionRole::kStructure, 0.0, false},
               {"base", 40, 115, 160, 70, RegionRole::kBase, 0.0, false}};
  return c;
}

void call_all_seen_inliers(TrackFrame& tracks) {
  for (TrackPoint& point : tracks.points) point.inlier = point.seen;
}

double mean_shift(const TrackFrame& tracks, const TrackFrame& keyframe, std::uint16_t region) {
  double sum = 0.0;
  int n = 0;
  for (std::size_t i = 0; i < tracks.points.size(); ++i) {
    if (tracks.points[i].region != region || !tracks.points[i].seen) continue;
    sum += tracks.points[i].u_px - keyframe.points[i].u_px;
    ++n;
  }
  return sum / n;
}

TEST(StructureTracker, FollowsEachRegionAndCopiesTheFramesFacts) {
  StructureTracker tracker(config());
  ASSERT_EQ(tracker.seed(frame_of(plates(0.0, 0.0), 0)), "");
  ASSERT_EQ(tracker.n_points(), 20U);
  TrackFrame keyframe, tracks;
  keyframe.points.resize(tracker.n_points());
  tracks.points.resize(tracker.n_points());
  ASSERT_TRUE(tracker.track(frame_of(plates(0.0, 0.0), 0), keyframe));
  // Steps well beyond the window, but never far from the region's last position.
  for (std::uint64_t k = 1; k <= 6; ++k) {
    const double step = static_cast<double>(k);
    ASSERT_TRUE(tracker.track(frame_of(plates(5.3 * step, -4.1 * step), k), tracks));
    call_all_seen_inliers(tracks);
    tracker.learn(tracks);
    EXPECT_EQ(tracks.sequence, k);
    EXPECT_EQ(tracks.t_start_ns, static_cast<std::int64_t>(k) * 40'000'000);
    EXPECT_EQ(tracks.gap_before, k == 3);
    EXPECT_NEAR(mean_shift(tracks, keyframe, 0), 5.3 * step, 0.02);
    EXPECT_NEAR(mean_shift(tracks, keyframe, 1), -4.1 * step, 0.02);
  }
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(tracks.points[i].region, i < 10 ? 0 : 1);
}

// One plate is covered, the other leaves the image: each loss says why.
TEST(StructureTracker, SaysWhyPointsAreLost) {
  StructureTracker tracker(config());
  ASSERT_EQ(tracker.seed(frame_of(plates(0.0, 0.0), 0)), "");
  TrackFrame tracks;
  tracks.points.resize(tracker.n_points());
  for (std::uint64_t k = 1; k <= StructureTracker::kLostForGood + 80; ++k) {
    cv::Mat gray = plates(0.0, std::min(4.0 * static_cast<double>(k), 200.0));
    if (k > 10) gray(cv::Rect(0, 0, kWidth, kHeight / 2)).setTo(100);
    ASSERT_TRUE(tracker.track(frame_of(gray, k), tracks));
    call_all_seen_inliers(tracks);
    tracker.learn(tracks);
    if (k == 10) {
      EXPECT_EQ(tracker.losses().total(), 0U);
    }
  }
  // Every seen point counts as an inlier here, so one may match by chance for a frame.
  EXPECT_GE(tracker.losses().total(), 18U);
  EXPECT_GE(tracker.losses().unlike, 9U);
  EXPECT_GE(tracker.losses().left_image, 5U);
  EXPECT_EQ(tracker.losses().unlike + tracker.losses().left_image, tracker.losses().total());
  EXPECT_EQ(tracker.losses().elsewhere, 0U);
}

// A point that was called an outlier is looked for where its region is, not where it strayed to.
TEST(StructureTracker, AnOutlierIsLookedForWithItsRegion) {
  StructureTracker tracker(config());
  ASSERT_EQ(tracker.seed(frame_of(plates(0.0, 0.0), 0)), "");
  TrackFrame keyframe, tracks;
  keyframe.points.resize(tracker.n_points());
  tracks.points.resize(tracker.n_points());
  ASSERT_TRUE(tracker.track(frame_of(plates(0.0, 0.0), 0), keyframe));

  cv::Mat covered = plates(12.0, 0.0);
  const TrackPoint& hidden = keyframe.points[4];
  const cv::Rect patch(cvRound(hidden.u_px + 12.0) - 18, std::max(0, cvRound(hidden.v_px) - 18), 37, 37);
  covered(patch & cv::Rect(0, 0, kWidth, kHeight / 2)).setTo(128);
  ASSERT_TRUE(tracker.track(frame_of(covered, 1), tracks));
  call_all_seen_inliers(tracks);
  tracks.points[4].inlier = false;
  tracker.learn(tracks);

  ASSERT_TRUE(tracker.track(frame_of(plates(12.5, 0.0), 2), tracks));
  EXPECT_TRUE(tracks.points[4].seen);
  EXPECT_NEAR(tracks.points[4].u_px - keyframe.points[4].u_px, 12.5, 0.05);
}

// The camera sinks until the upper region has left the image, drifts sideways, and rises again.
TEST(StructureTracker, ARegionThatLeftTheImageIsFoundAgainWithItsDatum) {
  const AnalyticTexture texture(33);
  const auto seen_from = [&](double du, double dv) { return texture.image(kWidth, kHeight, du, dv); };
  StructureTracker tracker(config());
  ASSERT_EQ(tracker.seed(frame_of(seen_from(0.0, 0.0), 0)), "");
  TrackFrame keyframe, tracks;
  keyframe.points.resize(tracker.n_points());
  tracks.points.resize(tracker.n_points());
  ASSERT_TRUE(tracker.track(frame_of(seen_from(0.0, 0.0), 0), keyframe));
  bool was_lost = false;
  std::uint64_t k = 0;
  const auto step = [&](double du, double dv) {
    ASSERT_TRUE(tracker.track(frame_of(seen_from(du, dv), ++k), tracks));
    call_all_seen_inliers(tracks);
    tracker.learn(tracks);
    was_lost = was_lost || tracker.regions().state(0) == RegionState::kLost;
    EXPECT_EQ(tracker.regions().state(1), RegionState::kMeasuring) << k;
  };
  for (double dv = -5.0; dv >= -95.0; dv -= 5.0) step(0.0, dv);
  EXPECT_TRUE(was_lost);
  for (double du = 4.0; du <= 60.0; du += 4.0) step(du, -95.0);
  for (double dv = -90.0; dv <= 0.0; dv += 5.0) step(60.0, dv);
  step(60.0, 0.0);
  EXPECT_EQ(tracker.regions().state(0), RegionState::kMeasuring);
  EXPECT_NEAR(mean_shift(tracks, keyframe, 0), 60.0, 0.05);
}

TEST(StructureTracker, SaysWhichRegionHasTooLittleTextureAndWhatToTry) {
  cv::Mat gray = plates(0.0, 0.0);
  gray(cv::Rect(0, kHeight / 2, kWidth, kHeight / 2)).setTo(255);
  StructureTracker tracker(config());
  const std::string refusal = tracker.seed(frame_of(gray, 0));
  EXPECT_NE(refusal.find("'base'"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("[40, 115, 160, 70]"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("corner_quality"), std::string::npos) << refusal;
  EXPECT_EQ(refusal.find("'roof'"), std::string::npos) << refusal;
}

TEST(StructureTracker, RefusesATinyImageInWords) {
  StructureTracker tracker(config());
  EXPECT_NE(tracker.seed(frame_of(cv::Mat::zeros(1, 1, CV_8UC1), 0)), "");
}

TEST(StructureTracker, ABlackFrameLosesAllPointsAndTheNextFindsThem) {
  StructureTracker tracker(config());
  ASSERT_EQ(tracker.seed(frame_of(plates(0.0, 0.0), 0)), "");
  TrackFrame tracks;
  tracks.points.resize(tracker.n_points());
  ASSERT_TRUE(tracker.track(frame_of(cv::Mat::zeros(kHeight, kWidth, CV_8UC1), 1), tracks));
  for (const TrackPoint& point : tracks.points) EXPECT_FALSE(point.seen);
  tracker.learn(tracks);
  ASSERT_TRUE(tracker.track(frame_of(plates(1.0, 1.0), 2), tracks));
  for (const TrackPoint& point : tracks.points) EXPECT_TRUE(point.seen);
}

}  // namespace
}  // namespace core
