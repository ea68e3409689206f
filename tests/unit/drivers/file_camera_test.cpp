#include "drivers/camera/recording/file_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "tests/support/camera_drain.h"
#include "tests/support/test_clip.h"

namespace drivers {
namespace {

using namespace std::chrono_literals;
using test_support::clip_image;
using test_support::ClipShape;
using test_support::drain;
using test_support::Drained;
using test_support::fresh_folder;
using test_support::make_slot;
using test_support::write_clip;
using test_support::write_image_folder;
using test_support::write_timestamps;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(FileCamera, DeliversEveryFrameOfAVideoOnceAndInOrder) {
  const auto clip = fresh_folder() / "clip.avi";
  write_clip(clip, {.n_frames = 53, .rate_hz = 25.0});
  FileCamera camera({.source = clip.string(), .exposure_ms = 4.0});
  EXPECT_EQ(camera.info().width_px, 64);
  EXPECT_EQ(camera.info().height_px, 48);
  EXPECT_EQ(camera.info().frame_count, 53u);
  EXPECT_DOUBLE_EQ(camera.info().rate_hz, 25.0);
  EXPECT_EQ(camera.info().exposure_ns, 4'000'000);
  EXPECT_TRUE(camera.info().lossless);
  camera.start();
  const Drained run = drain(camera);
  EXPECT_EQ(run.last, CaptureStatus::kEndOfStream);
  EXPECT_THAT(run.fault, IsEmpty());
  ASSERT_EQ(run.frames.size(), 53u);
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    const core::Frame& frame = run.frames[i];
    EXPECT_EQ(frame.sequence, i);
    EXPECT_EQ(frame.t_start_ns, static_cast<std::int64_t>(i) * 40'000'000);
    EXPECT_EQ(frame.exposure_ns, 4'000'000);
    EXPECT_FALSE(frame.gap_before);
    const cv::Mat written = clip_image(static_cast<int>(i), 64, 48);
    EXPECT_NEAR(frame.pixels[0], written.at<std::uint8_t>(0, 0), 3) << "frame " << i;
  }
}

TEST(FileCamera, FillsTheSlotInPlace) {
  const auto clip = fresh_folder() / "clip.avi";
  write_clip(clip);
  FileCamera camera({.source = clip.string()});
  core::Frame slot = make_slot(camera.info());
  const std::uint8_t* const pixels = slot.pixels.data();
  camera.start();
  ASSERT_EQ(camera.capture(slot, 10s), CaptureStatus::kFrame);
  EXPECT_EQ(slot.pixels.data(), pixels);
  EXPECT_EQ(slot.width_px, 64);
  EXPECT_EQ(slot.height_px, 48);
}

TEST(FileCamera, GivesTheSamePixelsTwice) {
  const auto clip = fresh_folder() / "clip.mp4";
  write_clip(clip, {.n_frames = 30, .width_px = 96, .height_px = 80});
  FileCamera first({.source = clip.string()});
  FileCamera second({.source = clip.string()});
  first.start();
  second.start();
  const Drained a = drain(first);
  const Drained b = drain(second);
  ASSERT_EQ(a.frames.size(), 30u);
  ASSERT_EQ(b.frames.size(), 30u);
  for (std::size_t i = 0; i < 30; ++i) EXPECT_EQ(a.frames[i].pixels, b.frames[i].pixels) << "frame " << i;
}

TEST(FileCamera, KeepsReturningTheEnd) {
  const auto clip = fresh_folder() / "clip.avi";
  write_clip(clip, {.n_frames = 3});
  FileCamera camera({.source = clip.string()});
  camera.start();
  ASSERT_EQ(drain(camera).frames.size(), 3u);
  core::Frame slot = make_slot(camera.info());
  EXPECT_EQ(camera.capture(slot, 1h), CaptureStatus::kEndOfStream);
  camera.stop();
  EXPECT_EQ(camera.capture(slot, 1h), CaptureStatus::kEndOfStream);
}

TEST(FileCamera, ReadsOddSizes) {
  const auto folder = fresh_folder();
  write_image_folder(folder / "odd", {.n_frames = 3, .width_px = 33, .height_px = 47});
  write_clip(folder / "odd.avi", {.n_frames = 3, .width_px = 131, .height_px = 77});
  for (const auto& source : {folder / "odd", folder / "odd.avi"}) {
    FileCamera camera({.source = source.string(), .rate_hz = 10.0});
    camera.start();
    EXPECT_EQ(drain(camera).frames.size(), 3u) << source;
  }
}

TEST(FileCamera, BelievesTheConfiguredRateAgainstTheContainer) {
  const auto clip = fresh_folder() / "clip.avi";
  write_clip(clip, {.n_frames = 4, .rate_hz = 50.0});
  for (const double rate_hz : {1e-3, 1.0, 29.97, 1000.0, 1e5, 1e6}) {
    FileCamera camera({.source = clip.string(), .rate_hz = rate_hz});
    EXPECT_DOUBLE_EQ(camera.info().rate_hz, rate_hz);
    camera.start();
    const Drained run = drain(camera);
    ASSERT_EQ(run.frames.size(), 4u);
    EXPECT_EQ(run.frames[3].t_start_ns, std::llround(3e9 / rate_hz));
  }
}

TEST(FileCamera, ReadsOneFrameASecondAndAHundredThousand) {
  const auto folder = fresh_folder();
  for (const double rate_hz : {1.0, 1e5}) {
    const auto clip = folder / (std::to_string(std::lround(rate_hz)) + ".mov");
    write_clip(clip, {.n_frames = 5, .rate_hz = rate_hz});
    FileCamera camera({.source = clip.string()});
    EXPECT_DOUBLE_EQ(camera.info().rate_hz, rate_hz);
    camera.start();
    const Drained run = drain(camera);
    ASSERT_EQ(run.frames.size(), 5u);
    EXPECT_EQ(run.frames[4].t_start_ns, std::llround(4e9 / rate_hz));
  }
}

TEST(FileCamera, TakesTimesAndRateFromTheTimeStampFile) {
  const auto folder = fresh_folder();
  write_clip(folder / "clip.avi", {.n_frames = 4, .rate_hz = 25.0});
  write_timestamps(folder / "clip.timestamps.csv", {4.438, 4.488, 4.538, 4.738});
  FileCamera camera({.source = (folder / "clip.avi").string()});
  EXPECT_NEAR(camera.info().rate_hz, 20.0, 1e-9) << "of the frames that follow one another, not the mean";
  camera.start();
  const Drained run = drain(camera);
  ASSERT_EQ(run.frames.size(), 4u);
  EXPECT_EQ(run.frames[0].t_start_ns, 4'438'000'000);
  EXPECT_EQ(run.frames[3].t_start_ns, 4'738'000'000);
  EXPECT_EQ(run.frames[3].sequence, 6U) << "three frames are missing before it";
  EXPECT_EQ(camera.times().n_lost, 3U);
  EXPECT_THAT(run.fault, IsEmpty());
}

TEST(FileCamera, KeepsStampedTimesWhenARateIsGivenToo) {
  const auto folder = fresh_folder();
  write_image_folder(folder / "images", {.n_frames = 3});
  write_timestamps(folder / "images" / "timestamps.csv", {0.0, 0.06, 0.1});
  FileCamera camera({.source = (folder / "images").string(), .rate_hz = 20.0});
  EXPECT_DOUBLE_EQ(camera.info().rate_hz, 20.0);
  camera.start();
  const Drained run = drain(camera);
  ASSERT_EQ(run.frames.size(), 3u);
  EXPECT_EQ(run.frames[1].t_start_ns, 60'000'000);
}

TEST(FileCamera, ReadsAnImageFolderInNaturalOrder) {
  const auto folder = fresh_folder();
  write_image_folder(folder / "images", {.n_frames = 12});
  test_support::write_text(folder / "images" / "notes.txt", "not an image");
  test_support::write_text(folder / "images" / "._frame_1.png", "resource fork");
  FileCamera camera({.source = (folder / "images").string(), .rate_hz = 10.0});
  EXPECT_EQ(camera.info().frame_count, 12u);
  camera.start();
  const Drained run = drain(camera);
  ASSERT_EQ(run.frames.size(), 12u);
  for (int i = 0; i < 12; ++i) {
    const cv::Mat written = clip_image(i, 64, 48);
    const auto& pixels = run.frames[static_cast<std::size_t>(i)].pixels;
    EXPECT_TRUE(std::equal(pixels.begin(), pixels.end(), written.datastart)) << "frame " << i;
  }
}

TEST(FileCamera, StopsInMidStreamAndEndsThen) {
  const auto clip = fresh_folder() / "clip.avi";
  write_clip(clip, {.n_frames = 200});
  FileCamera camera({.source = clip.string()});
  core::Frame slot = make_slot(camera.info());
  camera.start();
  for (int i = 0; i < 3; ++i) ASSERT_EQ(camera.capture(slot, 10s), CaptureStatus::kFrame);
  camera.stop();
  EXPECT_EQ(camera.capture(slot, 1h), CaptureStatus::kEndOfStream);
  EXPECT_THAT(camera.fault(), IsEmpty());
  camera.stop();
  camera.start();
  EXPECT_THROW(camera.start(), std::runtime_error) << "without a stop";
  ASSERT_EQ(camera.capture(slot, 10s), CaptureStatus::kFrame);
  EXPECT_EQ(slot.sequence, 0u);
}

TEST(FileCamera, StopWakesACaptureThatWaitsForItsTime) {
  const auto clip = fresh_folder() / "clip.avi";
  write_clip(clip, {.n_frames = 10});
  FileCamera camera({.source = clip.string(), .rate_hz = 1e-3, .realtime = true});  // the second frame: after 1000 s
  EXPECT_FALSE(camera.info().lossless);
  core::Frame slot = make_slot(camera.info());
  camera.start();
  ASSERT_EQ(camera.capture(slot, 10s), CaptureStatus::kFrame);
  EXPECT_EQ(camera.capture(slot, 5ms), CaptureStatus::kTimeout);
  std::thread stopper([&camera] { camera.stop(); });
  while (camera.capture(slot, 1h) == CaptureStatus::kTimeout) {
  }
  stopper.join();
  EXPECT_EQ(camera.capture(slot, 1h), CaptureStatus::kEndOfStream);
}

TEST(FileCamera, RealtimeHandsNoFrameOutBeforeItsTime) {
  const auto folder = fresh_folder();
  write_clip(folder / "clip.avi", {.n_frames = 5});
  write_timestamps(folder / "clip.timestamps.csv", {1.7e9, 1.7e9 + 0.01, 1.7e9 + 0.02, 1.7e9 + 0.03, 1.7e9 + 0.04});
  FileCamera camera({.source = (folder / "clip.avi").string(), .realtime = true});
  core::Frame slot = make_slot(camera.info());
  const auto started = std::chrono::steady_clock::now();
  camera.start();
  std::int64_t first_ns = 0;
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(camera.capture(slot, 10s), CaptureStatus::kFrame);
    if (i == 0) first_ns = slot.t_start_ns;
    EXPECT_GE((std::chrono::steady_clock::now() - started).count(), slot.t_start_ns - first_ns);
  }
}

TEST(FileCamera, DestroyedWithoutStopJoinsItsThread) {
  const auto clip = fresh_folder() / "clip.avi";
  write_clip(clip, {.n_frames = 100});
  FileCamera camera({.source = clip.string()});
  camera.start();
  SUCCEED() << "a thread left running would end the process in std::terminate";
}

TEST(FileCamera, RefusesASlotOfTheWrongSize) {
  const auto clip = fresh_folder() / "clip.avi";
  write_clip(clip);
  FileCamera camera({.source = clip.string()});
  core::Frame slot = make_slot(camera.info());
  slot.pixels.resize(10);
  camera.start();
  EXPECT_EQ(camera.capture(slot, 10s), CaptureStatus::kFault);
  EXPECT_THAT(camera.fault(), AllOf(HasSubstr("10 bytes"), HasSubstr("64 x 48")));
}

// Where in the delivered image the sensor's first line lies must be where the readout direction begins.
TEST(FileCamera, TurnsTheReadoutDirectionWithTheImage) {
  using enum core::ReadoutDirection;
  struct Case {
    int clockwise_deg;
    int width_px, height_px;
    core::ReadoutDirection direction;
    std::size_t first_line_u, first_line_v, last_line_u, last_line_v;  // a pixel near either end
  };
  const auto clip = fresh_folder() / "clip.mp4";
  for (const Case& c : {Case{0, 96, 64, kDown, 48, 4, 48, 60}, Case{90, 64, 96, kLeft, 60, 48, 4, 48},
                        Case{180, 96, 64, kUp, 48, 60, 48, 4}, Case{270, 64, 96, kRight, 4, 48, 60, 48}}) {
    {
      cv::VideoWriter writer(clip.string(), cv::CAP_FFMPEG, cv::VideoWriter::fourcc('m', 'p', '4', 'v'), 25.0,
                             {96, 64});
      cv::Mat image(64, 96, CV_8UC3, cv::Scalar::all(40));
      image.rowRange(0, 16) = cv::Scalar::all(220);  // the sensor's first lines are bright
      for (int i = 0; i < 5; ++i) writer.write(image);
    }
    test_support::set_mp4_rotation(clip, c.clockwise_deg);
    FileCamera camera({.source = clip.string(), .readout_ms = -20.0, .readout_direction = kDown});
    EXPECT_EQ(camera.info().width_px, c.width_px);
    EXPECT_EQ(camera.info().height_px, c.height_px);
    EXPECT_EQ(camera.info().readout_direction, c.direction) << c.clockwise_deg;
    EXPECT_EQ(camera.info().readout_ns, -20'000'000);
    camera.start();
    const Drained run = drain(camera);
    ASSERT_EQ(run.frames.size(), 5u);
    const auto at = [&](std::size_t u, std::size_t v) {
      return run.frames[0].pixels[v * static_cast<std::size_t>(c.width_px) + u];
    };
    EXPECT_GT(at(c.first_line_u, c.first_line_v), 180) << c.clockwise_deg;
    EXPECT_LT(at(c.last_line_u, c.last_line_v), 80) << c.clockwise_deg;
  }
}

}  // namespace
}  // namespace drivers
