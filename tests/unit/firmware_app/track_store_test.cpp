#include "firmware_app/chain/track_store.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace app {
namespace {

constexpr std::size_t kPoints = 9;

core::TrackFrame frame_of(std::uint64_t sequence, double reach_px = 3.0) {
  std::mt19937_64 random(sequence + 1);
  std::uniform_real_distribution<double> place(-reach_px, reach_px);
  core::TrackFrame frame;
  frame.sequence = sequence;
  frame.t_start_ns = static_cast<std::int64_t>(sequence) * 33'366'700 + 5;
  frame.gap_before = sequence % 4 == 2;
  for (std::size_t i = 0; i < kPoints; ++i) {
    core::TrackPoint point{100.0 / 3.0 * static_cast<double>(i) + place(random), 57.25 + place(random)};
    point.sigma_px = 0.004 * std::exp(place(random) / reach_px);
    point.id = static_cast<std::uint32_t>(i + 70), point.region = static_cast<std::uint16_t>(i / 3);
    point.seen = sequence == 0 || (sequence + i) % 5 != 0;
    frame.points.push_back(point);
  }
  return frame;
}

void expect_same(const core::TrackFrame& a, const core::TrackFrame& b) {
  EXPECT_EQ(a.sequence, b.sequence);
  EXPECT_EQ(a.t_start_ns, b.t_start_ns);
  EXPECT_EQ(a.gap_before, b.gap_before);
  for (std::size_t i = 0; i < kPoints; ++i) {
    EXPECT_EQ(a.points[i].seen, b.points[i].seen);
    EXPECT_EQ(a.points[i].id, b.points[i].id);
    EXPECT_EQ(a.points[i].region, b.points[i].region);
    if (!a.points[i].seen) continue;
    EXPECT_EQ(a.points[i].u_px, b.points[i].u_px);
    EXPECT_EQ(a.points[i].v_px, b.points[i].v_px);
    EXPECT_EQ(a.points[i].sigma_px, b.points[i].sigma_px);
  }
}

TEST(TrackLattice, RoundsByLessThanAnyTrackerErrsAndOnlyOnce) {
  const TrackLattice lattice(frame_of(0));
  for (std::uint64_t k = 1; k < 50; ++k) {
    const core::TrackFrame measured = frame_of(k, 200.0);
    core::TrackFrame rounded = measured;
    lattice.round(rounded);
    for (std::size_t i = 0; i < kPoints; ++i) {
      if (!measured.points[i].seen) continue;
      EXPECT_NEAR(rounded.points[i].u_px, measured.points[i].u_px, 0.5000001 / 8192.0);
      EXPECT_NEAR(rounded.points[i].sigma_px / measured.points[i].sigma_px, 1.0, 0.0005);
    }
    core::TrackFrame twice = rounded;
    lattice.round(twice);
    expect_same(rounded, twice);
  }
}

TEST(TrackLattice, WhatIsTooFarOrNoNumberIsNotSeen) {
  const TrackLattice lattice(frame_of(0));
  core::TrackFrame frame = frame_of(1);
  for (core::TrackPoint& point : frame.points) point.seen = true;
  frame.points[0].u_px += 2000.0;
  frame.points[1].v_px = std::nan("");
  frame.points[2].sigma_px = std::nan("");
  lattice.round(frame);
  EXPECT_FALSE(frame.points[0].seen);
  EXPECT_FALSE(frame.points[1].seen);
  EXPECT_TRUE(frame.points[2].seen);
  EXPECT_GT(frame.points[2].sigma_px, 0.0);
}

TEST(TrackStore, GivesBackEveryBit) {
  TrackStore store(frame_of(0), 1 << 20, 0);
  const TrackLattice lattice(frame_of(0));
  for (std::uint64_t k = 0; k < 100; ++k) {
    core::TrackFrame frame = frame_of(k, 500.0);
    lattice.round(frame);
    store.add(frame, k < 60 ? 1 : 2);
  }
  ASSERT_EQ(store.n_frames(), 100U);
  core::TrackFrame read = frame_of(0);
  for (std::uint64_t k = 0; k < 100; ++k) {
    EXPECT_EQ(store.read(k, read), k < 60 ? 1U : 2U);
    core::TrackFrame expected = frame_of(k, 500.0);
    lattice.round(expected);
    expect_same(read, expected);
  }
}

TEST(TrackStore, OfALongRunKeepsTheNewestFrames) {
  constexpr std::size_t kBytes = 24 + 8 * kPoints;
  TrackStore store(frame_of(0), 10 * kBytes + 5, 0);
  for (std::uint64_t k = 0; k < 25; ++k) store.add(frame_of(k), 1);
  ASSERT_EQ(store.n_frames(), 10U);
  core::TrackFrame read = frame_of(0);
  (void)store.read(0, read);
  EXPECT_EQ(read.sequence, 15U);
  (void)store.read(9, read);
  EXPECT_EQ(read.sequence, 24U);
}

// Chunks of a megabyte: some 10 900 frames of 9 points each.
TEST(TrackStore, GivesBackEveryBitFromAFile) {
  constexpr std::uint64_t kFrames = 40'000, kSlots = 30'000;
  constexpr std::size_t kBytes = 24 + 8 * kPoints;
  TrackStore in_memory(frame_of(0), kSlots * kBytes, 0);
  TrackStore in_file(frame_of(0), kSlots * kBytes, 0, ::testing::TempDir());
  const TrackLattice lattice(frame_of(0));
  core::TrackFrame a = frame_of(0), b = a;
  const auto expect_same_frames = [&] {
    ASSERT_EQ(in_file.n_frames(), in_memory.n_frames());
    for (std::size_t i = 0; i < in_memory.n_frames(); i += 7) {
      ASSERT_EQ(in_file.read(i, a), in_memory.read(i, b));
      expect_same(a, b);
    }
  };
  for (std::uint64_t k = 0; k < kFrames; ++k) {
    core::TrackFrame frame = frame_of(k);
    lattice.round(frame);
    in_memory.add(frame, 1 + k % 2);
    in_file.add(frame, 1 + k % 2);
    if (k == 25'000) expect_same_frames();
  }
  expect_same_frames();
}

TEST(TrackStore, KeepsInMemoryWhatNoFileTakes) {
  TrackStore store(frame_of(0), 1 << 20, 0, "/nowhere/at/all");
  for (std::uint64_t k = 0; k < 30'000; ++k) store.add(frame_of(k), 1);
  core::TrackFrame read = frame_of(0);
  (void)store.read(store.n_frames() - 1, read);
  EXPECT_EQ(read.sequence, 29'999U);
}

TEST(TrackStore, AnHourOf64PointsFitsInto64MB) {
  core::TrackFrame keyframe;
  keyframe.points.resize(64);
  TrackStore store(keyframe, std::size_t{64} << 20U, 0);
  for (std::uint64_t k = 0; k < 108'000; ++k) {
    keyframe.sequence = k;
    store.add(keyframe, 1);
  }
  EXPECT_EQ(store.n_frames(), 108'000U);
}

}  // namespace
}  // namespace app
