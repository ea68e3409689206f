#include "core/closure/observation/recent_tracks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/support/swaying_record.h"

namespace core::closure {
namespace {

using test_support::swaying_record;
using test_support::track_frame;

RecentTracks kept(const ObservationRecord& record, std::size_t n_frames, const CameraModel& camera) {
  ObservationRecord declared = record;
  declared.u_px.resize(0, 0), declared.v_px.resize(0, 0);
  declared.sigma_px.clear(), declared.region_of_point.clear();
  return {declared, camera, record.region_of_point, n_frames};
}

CameraModel camera_of(const ObservationRecord& record) {
  return {record.alpha_px, record.alpha_px, record.cx_px, record.cy_px, {}};
}

void add(RecentTracks& tracks, const TrackFrame& frame) {
  if (!tracks.begin_frame(frame.sequence)) return;
  for (std::size_t i = 0; i < frame.points.size(); ++i)
    if (frame.points[i].seen) tracks.place(i, frame.points[i]);
}

TEST(RecentTracks, HoldsTheNewestFramesInTheirOrder) {
  const ObservationRecord record = swaying_record(60, {});
  RecentTracks tracks = kept(record, 25, camera_of(record));
  for (Eigen::Index k = 0; k < 60; ++k) add(tracks, track_frame(record, k));
  EXPECT_EQ(tracks.n_frames(), 25U);
  EXPECT_EQ(tracks.first_sequence(), 35U);
  EXPECT_EQ(tracks.last_sequence(), 59U);
  const ObservationRecord out = tracks.record();
  ASSERT_EQ(out.n_frames(), 25);
  ASSERT_EQ(out.n_points(), record.n_points());
  EXPECT_LT((out.u_px - record.u_px.bottomRows(25)).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((out.v_px - record.v_px.bottomRows(25)).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(out.region_of_point, record.region_of_point);
  for (const double sigma : out.sigma_px) EXPECT_NEAR(sigma, 0.03, 1e-12);
  EXPECT_NEAR(out.raw_share[5], record.readout_share(record.u_px(0, 5), record.v_px(0, 5)), 1e-12);
}

TEST(RecentTracks, WhatDidNotComeIsMissing) {
  const ObservationRecord record = swaying_record(40, {});
  RecentTracks tracks = kept(record, 30, camera_of(record));
  for (Eigen::Index k = 0; k < 40; ++k) {
    if (k == 20 || k == 21) continue;
    TrackFrame frame = track_frame(record, k);
    if (k == 25) frame.points[3].seen = false;
    add(tracks, frame);
  }
  const ObservationRecord out = tracks.record();
  ASSERT_EQ(out.n_frames(), 30);
  for (Eigen::Index i = 0; i < 30; ++i) {
    const Eigen::Index k = i + 10;
    for (Eigen::Index j = 0; j < out.n_points(); ++j)
      EXPECT_EQ(std::isnan(out.u_px(i, j)), k == 20 || k == 21 || (k == 25 && j == 3)) << k << " " << j;
  }
}

TEST(RecentTracks, OldAndRepeatedFramesDoNotCountAndALongGapBeginsAnew) {
  const ObservationRecord record = swaying_record(20, {});
  RecentTracks tracks = kept(record, 10, camera_of(record));
  EXPECT_EQ(tracks.n_frames(), 0U);
  for (Eigen::Index k = 0; k < 5; ++k) add(tracks, track_frame(record, k));
  EXPECT_FALSE(tracks.begin_frame(4));
  EXPECT_FALSE(tracks.begin_frame(0));
  EXPECT_EQ(tracks.n_frames(), 5U);
  EXPECT_TRUE(tracks.begin_frame(1'000'000'000'000));
  EXPECT_EQ(tracks.n_frames(), 1U);
  EXPECT_TRUE(std::isnan(tracks.record().u_px(0, 0)));
  EXPECT_TRUE(tracks.begin_frame(UINT64_MAX));
  EXPECT_EQ(tracks.n_frames(), 1U);
}

TEST(RecentTracks, UndistortsWithOneScaleAlongBothAxes) {
  const ObservationRecord record = swaying_record(3, {});
  CameraModel camera = camera_of(record);
  camera.fy = 0.5 * camera.fx;
  camera.distortion = {-0.2, 0.0, 0.0, 0.0, 0.0};
  RecentTracks tracks = kept(record, 3, camera);
  add(tracks, track_frame(record, 0));
  const ObservationRecord out = tracks.record();
  const Vector2 ideal = camera.undistort({record.u_px(0, 7), record.v_px(0, 7)});
  EXPECT_DOUBLE_EQ(out.u_px(0, 7), ideal.u);
  EXPECT_DOUBLE_EQ(out.v_px(0, 7), camera.cy + 2.0 * (ideal.v - camera.cy));
}

TEST(RecentTracks, RefusesToKeepNothing) {
  const ObservationRecord record = swaying_record(3, {});
  EXPECT_THROW((void)kept(record, 0, camera_of(record)), std::invalid_argument);
}

}  // namespace
}  // namespace core::closure
