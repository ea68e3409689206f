#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/closure/observation/recent_tracks.h"
#include "core/geometry/channel_displacement.h"
#include "core/geometry/motion_axes.h"
#include "core/identification/mode_tracker.h"
#include "core/spectrum/time_grid.h"
#include "core/spectrum/welch_cpsd.h"
#include "core/tracking/outlier_rejection.h"
#include "core/tracking/point_finder.h"
#include "core/tracking/preview_maker.h"
#include "tests/support/alloc_guard.h"
#include "tests/support/swaying_record.h"

namespace core {
namespace {

using test_support::AllocGuard;

TEST(RunPathAllocation, WelchPushAndFlushAllocateNothing) {
  WelchConfig config;
  config.n_channels = 4;
  config.segment = 48;
  config.rate_hz = 25.0;
  WelchCpsd welch(config);
  CpsdSums snapshot = WelchCpsd::empty_sums(config);
  std::vector<double> value(4);
  const std::vector<std::uint8_t> seen(4, 1);
  std::size_t n_calls = 0;
  {
    const AllocGuard guard;
    for (int t = 0; t < 500; ++t) {
      for (std::size_t c = 0; c < 4; ++c) value[c] = std::sin(0.3 * t + static_cast<double>(c));
      const bool hop = t % 11 == 3 ? welch.push_missing() : welch.push(value, seen);
      if (hop) snapshot = welch.sums();
    }
    welch.flush();
    snapshot = welch.sums();
    n_calls = guard.n_new() + guard.n_delete();
  }
  EXPECT_GT(snapshot.n_segments, 15U);
  EXPECT_EQ(n_calls, 0U);
}

// Points in two regions of a smooth texture that moves: found, corrected for deformation, templates averaged.
TEST(RunPathAllocation, FindingPointsAllocatesNothing) {
  constexpr int kWidth = 200, kHeight = 120, kImages = 20;
  std::vector<std::vector<std::uint8_t>> images(kImages);
  for (int k = 0; k < kImages; ++k)
    for (int v = 0; v < kHeight; ++v)
      for (int u = 0; u < kWidth; ++u)
        images[static_cast<std::size_t>(k)].push_back(
            static_cast<std::uint8_t>(128.0 + 6.0 * std::sin(0.7 * (u - 0.1 * k) + 0.2 * v) +
                                      6.0 * std::sin(0.5 * v - 0.3 * (u - 0.1 * k)) + (u * 7 + v * 13 + k * 29) % 5));
  const auto view = [&](int k) {
    return GrayView{images[static_cast<std::size_t>(k)].data(), kWidth, kHeight, kWidth};
  };
  std::vector<Vector2> keyframe;
  std::vector<std::uint16_t> region;
  for (int i = 0; i < 20; ++i)
    keyframe.push_back({40.0 + 25.0 * (i % 5), 40.0 + 12.0 * (i / 5)}), region.push_back(i < 10 ? 0 : 1);
  RegionFollower follower(RegionFollowerConfig{kWidth, kHeight}, keyframe, region, 2);
  PointFinder finder({}, view(0), keyframe, region, 2);
  TrackFrame judged;
  judged.points.resize(keyframe.size());
  std::size_t n_calls = 0, n_seen = 0;
  {
    const AllocGuard guard;
    for (int k = 1; k < kImages; ++k) {
      finder.find(view(k), follower);
      for (std::size_t i = 0; i < keyframe.size(); ++i) {
        const KltPoint& p = finder.points()[i];
        judged.points[i] = {p.position.u, p.position.v, p.sigma_px, 0, region[i], p.seen, p.seen};
        n_seen += p.seen ? 1 : 0;
      }
      follower.update(judged);
      finder.learn(judged);
    }
    n_calls = guard.n_new() + guard.n_delete();
  }
  EXPECT_GT(n_seen, 19U * 15U);
  EXPECT_EQ(n_calls, 0U);
}

TEST(RunPathAllocation, RecentTracksAllocateNothing) {
  closure::ObservationRecord declared = test_support::swaying_record(40, {});
  std::vector<TrackFrame> frames;
  for (Eigen::Index k = 0; k < 40; ++k) frames.push_back(test_support::track_frame(declared, k));
  closure::RecentTracks tracks(declared, {2000.0, 2000.0, 960.0, 540.0, {}}, declared.region_of_point, 16);
  std::size_t n_calls = 0;
  {
    const AllocGuard guard;
    for (const TrackFrame& frame : frames) {
      if (frame.sequence % 7 == 5 || !tracks.begin_frame(frame.sequence)) continue;
      for (std::size_t i = 0; i < frame.points.size(); ++i) tracks.place(i, frame.points[i]);
    }
    n_calls = guard.n_new() + guard.n_delete();
  }
  EXPECT_EQ(tracks.n_frames(), 16U);
  EXPECT_EQ(n_calls, 0U);
}

TEST(RunPathAllocation, MotionAxesAllocateNothing) {
  const std::vector<Region> regions(3);
  MotionAxes axes(regions, 30);
  TrackFrame frame;
  frame.points.resize(30);
  for (std::size_t i = 0; i < 30; ++i)
    frame.points[i].region = static_cast<std::uint16_t>(i / 10), frame.points[i].seen = true;
  std::size_t n_calls = 0;
  {
    const AllocGuard guard;
    for (int k = 0; k < 100; ++k) frame.t_start_ns += 40'000'000, axes.add(frame);
    n_calls = guard.n_new() + guard.n_delete();
  }
  EXPECT_EQ(axes.motion(2).n_samples, 75U);
  EXPECT_EQ(n_calls, 0U);
}

TEST(RunPathAllocation, TimeGridAllocatesNothing) {
  TimeGrid grid(25.0);
  std::size_t n_calls = 0;
  {
    const AllocGuard guard;
    for (std::int64_t i = 0; i < 1000; ++i) (void)grid.place(i * 40'000'000 + (i % 7) * 1'000'000);
    n_calls = guard.n_new() + guard.n_delete();
  }
  EXPECT_EQ(n_calls, 0U);
}

TEST(RunPathAllocation, PreviewMakerAllocatesNothing) {
  TrackFrame tracks;
  tracks.points.resize(40);
  PreviewMaker maker({1.0, 320}, 640, 480, tracks, 3);
  Preview preview = maker.prototype();
  Frame frame;
  frame.width_px = 640, frame.height_px = 480;
  frame.pixels.resize(640 * 480);
  std::size_t n_calls = 0;
  {
    const AllocGuard guard;
    if (maker.is_due(frame.t_start_ns)) maker.make(frame, tracks, preview);
    n_calls = guard.n_new() + guard.n_delete();
  }
  EXPECT_EQ(n_calls, 0U);
}

TrackFrame grid_of_points(std::uint16_t n_regions, int per_side) {
  TrackFrame frame;
  for (std::uint16_t r = 0; r < n_regions; ++r) {
    for (int i = 0; i < per_side * per_side; ++i) {
      TrackPoint point;
      point.u_px = 200.0 + 20.0 * (i % per_side);
      point.v_px = 50.0 + 100.0 * r + 20.0 * (i / per_side);
      point.sigma_px = 0.03;
      point.id = static_cast<std::uint32_t>(frame.points.size());
      point.region = r;
      point.seen = true;
      frame.points.push_back(point);
    }
  }
  return frame;
}

TEST(RunPathAllocation, ChannelDisplacementUpdateAllocatesNothing) {
  for (const bool paper : {false, true}) {
    ChannelDisplacementConfig config;
    for (const char* name : {"base", "floor", "roof"})
      config.regions.push_back({name, 0, 0, 1, 1, RegionRole::kStructure, 0.0, false});
    config.readout = {0.02, ReadoutDirection::kDown, 640, 480};
    config.rate_hz = 25.0;
    config.paper_method = paper;
    const TrackFrame keyframe = grid_of_points(3, 4);
    ChannelDisplacement channels(config, keyframe);
    TrackFrame tracks = keyframe;
    DisplacementSample sample = channels.sample_prototype();
    std::size_t n_calls = 0;
    {
      const AllocGuard guard;
      for (int t = 0; t < 50; ++t) {
        for (std::size_t i = 0; i < tracks.points.size(); ++i) {
          tracks.points[i].u_px = keyframe.points[i].u_px + std::sin(0.5 * t + keyframe.points[i].region);
          tracks.points[i].seen = (i + static_cast<std::size_t>(t)) % 9 != 0;
        }
        channels.update(tracks, sample);
      }
      n_calls = guard.n_new() + guard.n_delete();
    }
    EXPECT_EQ(sample.seen, std::vector<std::uint8_t>(3, 1));
    EXPECT_EQ(n_calls, 0U) << "paper method " << paper;
  }
}

TEST(RunPathAllocation, ModeTrackerUpdateAllocatesNothing) {
  ModeTracker tracker({.row_delay_s = std::vector<double>(12, 0.001)});
  ModalEstimate estimate;
  estimate.status = "ok";
  estimate.rate_hz = 25.0;
  for (int i = 0; i < 20; ++i) {
    Mode mode;
    mode.frequency_hz = mode.apparent_hz = 0.5 + 0.5 * i;
    mode.damping_ratio = 0.01;
    mode.shape.assign(12, {1.0, 0.0});
    mode.verdict = i % 5 == 4 ? Verdict::kAmbiguous : Verdict::kStructural;
    (mode.verdict == Verdict::kStructural ? estimate.modes : estimate.rejected).push_back(mode);
  }
  std::size_t n_calls = 0;
  {
    const AllocGuard guard;
    for (std::uint64_t k = 1; k <= 50; ++k) {
      estimate.number = k;
      estimate.n_samples = 1000 * k;
      estimate.duration_s = 40.0 * static_cast<double>(k);
      for (Mode& mode : estimate.modes) mode.apparent_hz += k % 7 == 0 ? 1.0 : 0.0;  // some come and go
      tracker.update(estimate);
    }
    n_calls = guard.n_new() + guard.n_delete();
  }
  EXPECT_GT(tracker.n_followed(), 10U);
  EXPECT_EQ(n_calls, 0U);
}

}  // namespace
}  // namespace core
