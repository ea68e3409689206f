// Telemetry that a camera writes beside its video.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "drivers/camera/recording/file_camera.h"
#include "tests/support/camera_drain.h"
#include "tests/support/ffmpeg_clip.h"
#include "tests/support/srt_text.h"
#include "tests/support/test_clip.h"

namespace drivers {
namespace {

using test_support::drain;
using test_support::ffmpeg;
using test_support::fresh_folder;
using test_support::kH264;
using test_support::noisy_film;
using test_support::quoted;
using test_support::SrtFrame;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr int kFrames = 100;

// A video whose container states 40 ms between frames, and the subtitles beside it.
std::filesystem::path film_with(const std::vector<SrtFrame>& frames) {
  const auto folder = fresh_folder();
  ffmpeg(fmt::format("{} {} {}", noisy_film(kFrames), kH264, quoted(folder / "DJI_0001.MP4")));
  test_support::write_text(folder / "DJI_0001.SRT", test_support::srt_text(frames));
  return folder / "DJI_0001.MP4";
}

std::vector<SrtFrame> even_frames(int n = kFrames) {
  std::vector<SrtFrame> out;
  for (int k = 0; k < n; ++k) out.push_back({.t_s = 7.0 + 0.04 * k});
  return out;
}

TEST(FileCameraTelemetry, FramesThatTheCameraLostWhileTheContainerIsEvenAreMissing) {
  std::vector<SrtFrame> frames = even_frames();
  for (std::size_t k = 50; k < frames.size(); ++k) frames[k].t_s += 3 * 0.04;
  FileCamera camera({.source = film_with(frames).string()});
  const core::RecordingTimes times = camera.times();
  EXPECT_EQ(times.from, "the times in DJI_0001.SRT");
  EXPECT_DOUBLE_EQ(times.rate_hz, 25.0);
  EXPECT_EQ(times.n_lost, 3U);
  camera.start();
  const auto run = drain(camera);
  ASSERT_EQ(run.frames.size(), 100U);
  EXPECT_EQ(run.frames[49].sequence, 49U);
  EXPECT_EQ(run.frames[50].sequence, 53U);
  EXPECT_EQ(run.frames[50].t_start_ns, 53 * 40'000'000LL);
}

TEST(FileCameraTelemetry, SmallScatterOfTheTimesIsNotTheFrames) {
  std::vector<SrtFrame> frames = even_frames();
  std::mt19937 random(1);
  std::normal_distribution<double> scatter(0.0, 0.0008);
  for (SrtFrame& frame : frames) frame.t_s += scatter(random);
  FileCamera camera({.source = film_with(frames).string()});
  EXPECT_NEAR(camera.info().rate_hz, 25.0, 0.005);
  EXPECT_NEAR(camera.times().jitter_s, 0.0008, 0.0002);
  camera.start();
  for (const core::Frame& frame : drain(camera).frames) {
    EXPECT_EQ(frame.t_start_ns, std::llround(static_cast<double>(frame.sequence) / camera.info().rate_hz * 1e9));
  }
}

TEST(FileCameraTelemetry, TimesThatCannotBeThoseOfTheFramesAreNotUsedAndItIsSaid) {
  std::vector<SrtFrame> wild = even_frames();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> scatter(0.0, 0.039);
  for (SrtFrame& frame : wild) frame.t_s += scatter(random);
  for (const auto& [frames, words] : {std::pair{wild, "scatter by"}, {even_frames(60), "60 for 100 frames"}}) {
    const FileCamera camera({.source = film_with(frames).string()});
    EXPECT_EQ(camera.times().from, "the container's times");
    EXPECT_THAT(camera.times().remark, AllOf(HasSubstr("DJI_0001.SRT were not used"), HasSubstr(words)));
    EXPECT_DOUBLE_EQ(camera.info().rate_hz, 25.0);
  }
}

TEST(FileCameraTelemetry, SlowMotionHasTheRateOfTheCamerasClock) {
  std::vector<SrtFrame> frames = even_frames();
  for (int k = 0; k < kFrames; ++k) frames[static_cast<std::size_t>(k)].t_s = 7.0 + k / 120.0;
  const FileCamera camera({.source = film_with(frames).string()});
  EXPECT_NEAR(camera.info().rate_hz, 120.0, 0.001);
  EXPECT_THAT(camera.times().remark, HasSubstr("the container states 25 Hz"));
}

TEST(FileCameraTelemetry, ExposureAndItsChangeAreReported) {
  std::vector<SrtFrame> frames = even_frames();
  for (std::size_t k = 80; k < frames.size(); ++k) frames[k].exposure_s = 0.004;
  const auto clip = film_with(frames);
  const FileCamera camera({.source = clip.string()});
  EXPECT_EQ(camera.info().exposure_ns, 1'000'000) << "the usual one";
  EXPECT_THAT(camera.times().remark, AllOf(HasSubstr("from DJI_0001.SRT: "),
                                           HasSubstr("exposure changes: 1/1000 s to 1/250 s, first at 3.2")));
  const FileCamera declared({.source = clip.string(), .exposure_ms = 2.0});
  EXPECT_EQ(declared.info().exposure_ns, 2'000'000);
}

TEST(FileCameraTelemetry, AZoomThatCannotBeFollowedIsRefusedWithItsPlace) {
  std::vector<SrtFrame> frames = even_frames();
  for (std::size_t k = 80; k < frames.size(); ++k) frames[k].focal_length = 280.0;
  try {
    const FileCamera camera({.source = film_with(frames).string()});
    FAIL() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("DJI_0001.MP4"), HasSubstr("focal length changes from 240 to 280"),
                                    HasSubstr("3.2"), HasSubstr("cut")));
  }
  for (std::size_t k = 80; k < frames.size(); ++k) frames[k].focal_length = 247.0;
  const FileCamera camera({.source = film_with(frames).string()});
  EXPECT_THAT(camera.times().remark, HasSubstr("focal length changes: 240 to 247"));
}

TEST(FileCameraTelemetry, SubtitlesThatAreNoneOfACameraAreSaidAndNotUsed) {
  const auto clip = film_with({});
  FileCamera camera({.source = clip.string()});
  EXPECT_THAT(camera.times().remark, HasSubstr("not readable"));
  EXPECT_EQ(camera.times().from, "the container's times");
  camera.start();
  EXPECT_EQ(drain(camera).frames.size(), 100U);
}

}  // namespace
}  // namespace drivers
