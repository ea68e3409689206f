#include "drivers/camera/synthetic_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "core/simulation/presets.h"
#include "tests/support/camera_drain.h"

namespace drivers {
namespace {

using namespace std::chrono_literals;
using test_support::drain;
using test_support::Drained;
using test_support::make_slot;
using ::testing::HasSubstr;

SyntheticCameraConfig small_scene(double duration_s) {
  SyntheticCameraConfig config{core::simulation::make_paper_scene(3, duration_s)};
  core::simulation::set_image_size(config.scene, 320, 180);
  return config;
}

TEST(SyntheticCamera, DeliversEveryFrameOfTheSceneAtItsTime) {
  SyntheticCamera camera(small_scene(0.4));
  EXPECT_TRUE(camera.info().lossless);
  EXPECT_EQ(camera.info().frame_count, 10u);
  EXPECT_EQ(camera.info().readout_ns, 26'000'000);
  EXPECT_EQ(camera.info().exposure_ns, 4'000'000);
  camera.start();
  const Drained run = drain(camera);
  EXPECT_EQ(run.last, CaptureStatus::kEndOfStream);
  ASSERT_EQ(run.frames.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(run.frames[i].sequence, i);
    EXPECT_EQ(run.frames[i].t_start_ns, static_cast<std::int64_t>(i) * 40'000'000);
    EXPECT_EQ(run.frames[i].width_px, 320);
    EXPECT_EQ(run.frames[i].height_px, 180);
  }
  EXPECT_NE(run.frames[0].pixels, run.frames[1].pixels);
}

TEST(SyntheticCamera, SameSceneSamePixels) {
  SyntheticCamera first(small_scene(0.2));
  SyntheticCamera second(small_scene(0.2));
  first.start();
  second.start();
  const Drained a = drain(first);
  const Drained b = drain(second);
  ASSERT_EQ(a.frames.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(a.frames[i].pixels, b.frames[i].pixels);
}

TEST(SyntheticCamera, TellsDroppedFramesAsGapsAndStampsAsTheyAreSaid) {
  SyntheticCameraConfig config = small_scene(8.0);
  config.scene.timing.drop_probability = 0.2;
  config.scene.timing.duplicate_probability = 0.1;
  config.scene.timing.jitter_rms_s = 0.003;
  SyntheticCamera camera(config);
  camera.start();
  const Drained run = drain(camera);
  core::simulation::FrameTiming timing(config.scene);
  core::simulation::DeliveredFrame wanted;
  std::uint64_t shown = ~std::uint64_t{0};
  std::size_t n = 0, n_gaps = 0, n_duplicates = 0;
  for (; timing.next(wanted); ++n) {
    ASSERT_LT(n, run.frames.size());
    EXPECT_EQ(run.frames[n].sequence, wanted.sequence);
    EXPECT_EQ(run.frames[n].t_start_ns, std::llround(wanted.stamp_s * 1e9));
    EXPECT_EQ(run.frames[n].gap_before, wanted.gap_before);
    n_gaps += wanted.gap_before ? 1 : 0;
    EXPECT_EQ(n > 0 && run.frames[n].pixels == run.frames[n - 1].pixels, wanted.number == shown);
    n_duplicates += wanted.number == shown ? 1 : 0;
    shown = wanted.number;
  }
  EXPECT_EQ(n, run.frames.size());
  EXPECT_EQ(n, camera.info().frame_count);
  EXPECT_GT(n_gaps, 10u);
  EXPECT_GT(n_duplicates, 5u);
}

TEST(SyntheticCamera, SaysNothingOfDropsWhereStampsDoNotTell) {
  SyntheticCameraConfig config = small_scene(2.0);
  config.scene.timing.drop_probability = 0.3;
  config.scene.timing.stamps_tell = false;
  SyntheticCamera camera(config);
  camera.start();
  const Drained run = drain(camera);
  ASSERT_LT(run.frames.size(), 45u);
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    EXPECT_EQ(run.frames[i].sequence, i);
    EXPECT_EQ(run.frames[i].t_start_ns, static_cast<std::int64_t>(i) * 40'000'000);
    EXPECT_FALSE(run.frames[i].gap_before);
  }
}

TEST(SyntheticCamera, StartsAnewWithTheSameFrames) {
  SyntheticCamera camera(small_scene(0.2));
  camera.start();
  const Drained first = drain(camera);
  camera.stop();
  camera.start();
  const Drained again = drain(camera);
  ASSERT_EQ(again.frames.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(again.frames[i].pixels, first.frames[i].pixels);
}

TEST(SyntheticCamera, EndsAfterStop) {
  SyntheticCamera camera(small_scene(1.0));
  core::Frame slot = make_slot(camera.info());
  camera.start();
  ASSERT_EQ(camera.capture(slot, 0ms), CaptureStatus::kFrame);
  camera.stop();
  EXPECT_EQ(camera.capture(slot, 1h), CaptureStatus::kEndOfStream);
}

TEST(SyntheticCamera, StopWakesACaptureThatWaitsForItsTime) {
  SyntheticCameraConfig config = small_scene(10.0);
  config.scene.camera.rate_hz = 1.0;
  config.realtime = true;
  SyntheticCamera camera(config);
  EXPECT_FALSE(camera.info().lossless);
  core::Frame slot = make_slot(camera.info());
  camera.start();
  ASSERT_EQ(camera.capture(slot, 0ms), CaptureStatus::kFrame);
  EXPECT_EQ(camera.capture(slot, 0ms), CaptureStatus::kTimeout);
  std::thread stopper([&camera] { camera.stop(); });
  CaptureStatus status = CaptureStatus::kFrame;
  while (status != CaptureStatus::kEndOfStream) status = camera.capture(slot, 1h);
  stopper.join();
  EXPECT_LT(slot.sequence, 9u);
}

TEST(SyntheticCamera, RefusesASlotOfTheWrongSize) {
  SyntheticCamera camera(small_scene(1.0));
  core::Frame slot;
  camera.start();
  EXPECT_EQ(camera.capture(slot, 0ms), CaptureStatus::kFault);
  EXPECT_THAT(camera.fault(), HasSubstr("320 x 180"));
}

TEST(SyntheticCamera, RefusesASceneThatHoldsNoFrame) {
  EXPECT_THROW(SyntheticCamera(small_scene(0.01)), std::invalid_argument);
}

}  // namespace
}  // namespace drivers
