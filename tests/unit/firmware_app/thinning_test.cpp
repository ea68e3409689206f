#include "firmware_app/service/stages/thinning.h"

#include <gtest/gtest.h>

namespace app {
namespace {

// A tracker that processes every `per_frame`-th of the arriving frames, however many are offered: otherwise its ring is
// full.
struct Camera {
  explicit Camera(double rate_hz, double takes_hz) : watch(rate_hz), per_frame(takes_hz / rate_hz) {}

  // Returns the stride requested after `n` frames of the source, 0 for none.
  std::uint32_t play(int n) {
    std::uint32_t asked = 0;
    for (int i = 0; i < n; ++i) {
      room += per_frame;
      if (room > 2.0) room = 2.0;  // a ring's worth
      if (sequence++ % stride != 0) continue;
      const bool dropped = room < 1.0;
      if (!dropped) room -= 1.0;
      n_dropped += dropped ? 1 : 0;
      if (const std::uint32_t told = watch.add(dropped); told != 0) stride = asked = told;
    }
    return asked;
  }

  OverloadWatch watch;
  double per_frame, room = 2.0;
  std::uint64_t sequence = 0;
  std::uint32_t stride = 1;
  int n_dropped = 0;
};

TEST(OverloadWatch, KeepsEveryFrameThatCanBeFollowed) {
  Camera camera(60.0, 60.0);
  EXPECT_EQ(camera.play(6000), 0U);
  EXPECT_EQ(camera.n_dropped, 0);
}

TEST(OverloadWatch, ASourceFourTimesTooFastIsThinnedSoThatNothingIsLostByChanceAnyMore) {
  Camera camera(100.0, 25.0);
  EXPECT_EQ(camera.play(1000), 5U) << "a tenth of the time is to spare";
  camera.n_dropped = 0;
  EXPECT_EQ(camera.play(10'000), 0U);
  EXPECT_EQ(camera.n_dropped, 0);
}

TEST(OverloadWatch, ABurstIsNoOverload) {
  OverloadWatch watch(50.0);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(watch.add(i >= 100 && i < 180), 0U) << i;  // most of one window only
}

TEST(OverloadWatch, AFewLossesNowAndThenAreNoOverload) {
  OverloadWatch watch(50.0);
  for (int i = 0; i < 5000; ++i) EXPECT_EQ(watch.add(i % 11 == 0), 0U) << i;
}

TEST(OverloadWatch, ThinsFurtherWhereTrackingBecomesSlowerStill) {
  Camera camera(100.0, 50.0);
  EXPECT_EQ(camera.play(1000), 3U);
  camera.per_frame = 0.1;
  EXPECT_GE(camera.play(3000), 10U);
}

TEST(OverloadWatch, TrackingThatTakesNothingEndsAtTheLargestStride) {
  OverloadWatch watch(25.0);
  std::uint32_t last = 0;
  for (int i = 0; i < 5000; ++i) {
    if (const std::uint32_t told = watch.add(true); told != 0) last = told;
  }
  EXPECT_EQ(last, 64U);
}

TEST(ThinningSchedule, TellsOfEveryFrameWhatWasDecidedBeforeIt) {
  ThinningSchedule schedule;
  EXPECT_EQ(schedule.at(1'000'000).stride, 1U);
  EXPECT_TRUE(schedule.change({101, 4}));
  EXPECT_TRUE(schedule.change({500, 7}));
  EXPECT_EQ(schedule.at(100).stride, 1U);
  EXPECT_EQ(schedule.at(101).stride, 4U);
  EXPECT_EQ(schedule.at(499).stride, 4U);
  EXPECT_EQ(schedule.newest().stride, 7U);
  EXPECT_TRUE(schedule.at(105).keeps(105));
  EXPECT_FALSE(schedule.at(106).keeps(106));
}

TEST(ThinningSchedule, RefusesAChangeForWhichThereIsNoRoom) {
  ThinningSchedule schedule;
  for (std::uint32_t i = 1; i < ThinningSchedule::kMaxChanges; ++i) EXPECT_TRUE(schedule.change({10 * i, i + 1}));
  EXPECT_FALSE(schedule.change({1000, 50}));
  EXPECT_EQ(schedule.newest().stride, ThinningSchedule::kMaxChanges);
}

}  // namespace
}  // namespace app
