#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <limits>
#include <random>

#include "drivers/camera/device_missing.h"
#include "drivers/camera/recording/file_camera.h"
#include "tests/support/camera_drain.h"
#include "tests/support/refused_clip.h"
#include "tests/support/test_clip.h"

namespace drivers {
namespace {

using test_support::clip_image;
using test_support::drain;
using test_support::Drained;
using test_support::fresh_folder;
using test_support::refusal;
using test_support::write_clip;
using test_support::write_image;
using test_support::write_image_folder;
using test_support::write_text;
using test_support::write_timestamps;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// The camera's error for `source`, "accepted" if there is none.
Drained run_through(const std::filesystem::path& source, double rate_hz = 0.0) {
  FileCamera camera({.source = source.string(), .rate_hz = rate_hz});
  camera.start();
  return drain(camera);
}

TEST(FileCameraBadInput, MissingSourceIsAMissingDevice) {
  const auto folder = fresh_folder();
  EXPECT_THROW(FileCamera({.source = (folder / "none.mp4").string()}), DeviceMissing);
  EXPECT_THROW(FileCamera({.source = ""}), DeviceMissing);
  EXPECT_THAT(refusal(folder / "none.mp4"), AllOf(HasSubstr("none.mp4"), HasSubstr("no such file")));
}

TEST(FileCameraBadInput, UnreadableFileAndFolder) {
  const auto folder = fresh_folder();
  write_clip(folder / "clip.avi");
  write_image_folder(folder / "images", {.n_frames = 2});
  using std::filesystem::perms;
  std::filesystem::permissions(folder / "clip.avi", perms::none);
  std::filesystem::permissions(folder / "images", perms::none);
  const bool is_root = geteuid() == 0;
  if (is_root) {
    ASSERT_EQ(seteuid(65534), 0);
  }  // root reads everything
  const std::string of_file = refusal(folder / "clip.avi");
  const std::string of_folder = refusal(folder / "images", {.rate_hz = 10.0});
  if (is_root) {
    ASSERT_EQ(seteuid(0), 0);
  }
  std::filesystem::permissions(folder / "images", perms::owner_all);
  EXPECT_THAT(of_file, AllOf(HasSubstr("clip.avi"), HasSubstr("no permission")));
  EXPECT_THAT(of_folder, AllOf(HasSubstr("images"), HasSubstr("no permission")));
}

TEST(FileCameraBadInput, EmptyFile) {
  const auto clip = fresh_folder() / "clip.mp4";
  write_text(clip, "");
  EXPECT_THAT(refusal(clip), AllOf(HasSubstr("clip.mp4"), HasSubstr("0 bytes")));
}

TEST(FileCameraBadInput, NeitherFileNorFolder) {
  EXPECT_THAT(refusal("/dev/zero"), HasSubstr("neither a file nor a folder"));
}

TEST(FileCameraBadInput, WhatIsNotAVideo) {
  const auto folder = fresh_folder();
  std::mt19937 random(7);
  std::string noise(20000, '\0');
  for (char& c : noise) c = static_cast<char>(random() & 0xff);
  write_text(folder / "noise.mp4", noise);
  std::string prose;
  for (int i = 0; i < 300; ++i) prose += "The structure sways.\n";
  write_text(folder / "prose.txt", prose);
  write_text(folder / "prose.mp4", prose);
  for (const char* name : {"noise.mp4", "prose.txt", "prose.mp4"}) {
    EXPECT_THAT(refusal(folder / name), AllOf(HasSubstr(name), HasSubstr("not a video"))) << name;
  }
  write_image(folder / "one.png", clip_image(0, 64, 48));
  EXPECT_THAT(refusal(folder / "one.png"), HasSubstr("single image"));
}

TEST(FileCameraBadInput, VideoCutOffBeforeItsIndex) {
  const auto clip = fresh_folder() / "clip.mp4";
  write_clip(clip);
  test_support::keep_first_bytes(clip, 0.5);
  EXPECT_THAT(refusal(clip), AllOf(HasSubstr("clip.mp4"), HasSubstr("cut off")));
}

TEST(FileCameraBadInput, VideoWithoutOneFrameThatDecodes) {
  const auto clip = fresh_folder() / "clip.avi";
  write_clip(clip);
  std::string bytes = test_support::read_bytes(clip);
  for (std::size_t at = bytes.find("00dc"); at != std::string::npos; at = bytes.find("00dc", at + 4)) {
    for (std::size_t i = at + 8; i < std::min(at + 600, bytes.size()); ++i) bytes[i] = 'x';
  }
  write_text(clip, bytes);
  EXPECT_THAT(refusal(clip), AllOf(HasSubstr("clip.avi"), HasSubstr("ffplay")));
}

TEST(FileCameraBadInput, TruncatedVideoDeliversWhatDecodesAndSaysSo) {
  const auto clip = fresh_folder() / "clip.avi";
  write_clip(clip, {.n_frames = 100});
  test_support::keep_first_bytes(clip, 0.5);
  const Drained run = run_through(clip);
  EXPECT_EQ(run.last, CaptureStatus::kEndOfStream);
  EXPECT_GT(run.frames.size(), 10u);
  EXPECT_LT(run.frames.size(), 90u);
  EXPECT_THAT(run.fault,
              AllOf(HasSubstr("promises 100 frames"), HasSubstr("decoded " + std::to_string(run.frames.size()))));
}

TEST(FileCameraBadInput, ImagesTooSmallToTrack) {
  const auto folder = fresh_folder();
  write_image_folder(folder / "dot", {.n_frames = 2, .width_px = 1, .height_px = 1});
  write_image_folder(folder / "strip", {.n_frames = 2, .width_px = 640, .height_px = 31});
  write_clip(folder / "tiny.avi", {.n_frames = 2, .width_px = 16, .height_px = 16});
  EXPECT_THAT(refusal(folder / "dot", {.rate_hz = 10.0}), AllOf(HasSubstr("1 x 1"), HasSubstr("32 x 32")));
  EXPECT_THAT(refusal(folder / "strip", {.rate_hz = 10.0}), HasSubstr("640 x 31"));
  EXPECT_THAT(refusal(folder / "tiny.avi"), AllOf(HasSubstr("tiny.avi"), HasSubstr("16 x 16")));
}

TEST(FileCameraBadInput, ImagesOf16BitFloatOrWithAlpha) {
  const auto folder = fresh_folder();
  const auto make = [&](const char* name, int type, const char* extension) {
    std::filesystem::create_directories(folder / name);
    write_image(folder / name / (std::string("frame_0") + extension), cv::Mat(48, 64, type, cv::Scalar::all(100)));
    return refusal(folder / name, {.rate_hz = 10.0});
  };
  EXPECT_THAT(make("deep", CV_16UC1, ".png"), AllOf(HasSubstr("frame_0.png"), HasSubstr("16 bits")));
  EXPECT_THAT(make("deep_colour", CV_16UC3, ".png"), HasSubstr("16 bits"));
  EXPECT_THAT(make("real", CV_32FC1, ".tif"), AllOf(HasSubstr("frame_0.tif"), HasSubstr("floating-point")));
  EXPECT_THAT(make("alpha", CV_8UC4, ".png"), AllOf(HasSubstr("frame_0.png"), HasSubstr("alpha")));
}

TEST(FileCameraBadInput, VideoOf16BitOrWithAlpha) {
  const auto folder = fresh_folder();
  const auto make = [&](const char* name, int type) {
    const cv::Mat image(48, 64, type, cv::Scalar::all(100));
    write_text(folder / name, test_support::image_stream(".png", {image, image, image}));
    return refusal(folder / name);
  };
  EXPECT_THAT(make("deep.video", CV_16UC1), AllOf(HasSubstr("deep.video"), HasSubstr("16 bit")));
  EXPECT_THAT(make("deep_colour.video", CV_16UC3), HasSubstr("16 bit"));
  EXPECT_THAT(make("alpha.video", CV_8UC4), HasSubstr("alpha"));
  EXPECT_THAT(make("deep_alpha.video", CV_16UC4), HasSubstr("alpha"));
  EXPECT_EQ(make("gray.video", CV_8UC1), "accepted");
  EXPECT_EQ(make("colour.video", CV_8UC3), "accepted");
}

TEST(FileCameraBadInput, FolderWithoutUsableImages) {
  const auto folder = fresh_folder();
  write_text(folder / "readme.txt", "nothing here");
  EXPECT_THAT(refusal(folder, {.rate_hz = 10.0}), HasSubstr("no image"));
  write_text(folder / "frame_0.png", "");
  EXPECT_THAT(refusal(folder, {.rate_hz = 10.0}), AllOf(HasSubstr("frame_0.png"), HasSubstr("0 bytes")));
  write_text(folder / "frame_0.png", "not a picture");
  EXPECT_THAT(refusal(folder, {.rate_hz = 10.0}), AllOf(HasSubstr("frame_0.png"), HasSubstr("cannot be decoded")));
}

TEST(FileCameraBadInput, FolderOfMixedSizes) {
  const auto folder = fresh_folder();
  write_image_folder(folder / "ends", {.n_frames = 4});
  write_image(folder / "ends" / "frame_9.png", clip_image(9, 80, 48));
  EXPECT_THAT(refusal(folder / "ends", {.rate_hz = 10.0}), AllOf(HasSubstr("frame_9.png"), HasSubstr("80 x 48")));

  write_image_folder(folder / "middle", {.n_frames = 6});
  write_image(folder / "middle" / "frame_3.png", clip_image(3, 48, 64));  // as many pixels
  const Drained run = run_through(folder / "middle", 10.0);
  EXPECT_EQ(run.last, CaptureStatus::kFault);
  EXPECT_EQ(run.frames.size(), 3u);
  EXPECT_THAT(run.fault, AllOf(HasSubstr("frame_3.png"), HasSubstr("48 x 64")));
}

TEST(FileCameraBadInput, DamagedImageInTheMiddleOfAFolder) {
  const auto folder = fresh_folder();
  write_image_folder(folder / "images", {.n_frames = 6});
  write_text(folder / "images" / "frame_2.png", "damaged");
  const Drained run = run_through(folder / "images", 10.0);
  EXPECT_EQ(run.last, CaptureStatus::kFault);
  EXPECT_EQ(run.frames.size(), 2u);
  EXPECT_THAT(run.fault, HasSubstr("frame_2.png"));
}

TEST(FileCameraBadInput, FolderWithoutARate) {
  const auto folder = fresh_folder();
  write_image_folder(folder / "images", {.n_frames = 2});
  EXPECT_THAT(refusal(folder / "images"), AllOf(HasSubstr("camera.rate_hz"), HasSubstr("timestamps.csv")));
}

TEST(FileCameraBadInput, RatesAndTimingsOutOfRange) {
  const auto clip = fresh_folder() / "clip.avi";
  write_clip(clip);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double rate_hz : {nan, -25.0, 1e-4, 1e7, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(FileCamera({.source = clip.string(), .rate_hz = rate_hz}), std::invalid_argument) << rate_hz;
  }
  for (const double readout_ms : {nan, 1001.0, -1001.0}) {
    EXPECT_THROW(FileCamera({.source = clip.string(), .readout_ms = readout_ms}), std::invalid_argument) << readout_ms;
  }
  for (const double exposure_ms : {nan, -1.0, 1e5}) {
    EXPECT_THROW(FileCamera({.source = clip.string(), .exposure_ms = exposure_ms}), std::invalid_argument)
        << exposure_ms;
  }
}

TEST(FileCameraBadInput, ContainerWithAnAbsurdRate) {
  const auto clip = fresh_folder() / "clip.avi";
  write_clip(clip, {.rate_hz = 25.0});
  std::string bytes = test_support::read_bytes(clip);
  const std::size_t stream_header = bytes.find("strh") + 8;
  const char scale_and_rate[] = {1, 0, 0, 0, 0, static_cast<char>(0xe1), static_cast<char>(0xf5), 5};  // 1e8 / 1
  bytes.replace(stream_header + 20, 8, scale_and_rate, 8);
  write_text(clip, bytes);
  EXPECT_THAT(refusal(clip), AllOf(HasSubstr("clip.avi"), HasSubstr("100000000"), HasSubstr("camera.rate_hz")));
  EXPECT_EQ(run_through(clip, 25.0).frames.size(), 20u);
}

TEST(FileCameraBadInput, FewerTimeStampsThanFrames) {
  const auto folder = fresh_folder();
  write_clip(folder / "clip.avi", {.n_frames = 5});
  write_timestamps(folder / "clip.timestamps.csv", {0.0, 0.1, 0.2, 0.3});
  EXPECT_THAT(refusal(folder / "clip.avi"),
              AllOf(HasSubstr("clip.timestamps.csv"), HasSubstr("4 time stamps for 5 frames")));
}

TEST(FileCameraBadInput, FewerTimeStampsThanFramesOfAStreamOfUnknownLength) {
  const auto folder = fresh_folder();
  const cv::Mat image = clip_image(0, 64, 48);
  write_text(folder / "clip.mjpeg", test_support::image_stream(".jpg", {image, image, image, image, image}));
  write_timestamps(folder / "clip.timestamps.csv", {0.0, 0.1, 0.2});
  EXPECT_THAT(refusal(folder / "clip.mjpeg"), HasSubstr("3 time stamps for 5 frames"));
}

TEST(FileCameraBadInput, MoreTimeStampsThanFrames) {
  const auto folder = fresh_folder();
  write_clip(folder / "clip.avi", {.n_frames = 3});
  write_timestamps(folder / "clip.timestamps.csv", {0.0, 0.1, 0.2, 0.3});
  const Drained run = run_through(folder / "clip.avi");
  EXPECT_EQ(run.last, CaptureStatus::kEndOfStream);
  EXPECT_EQ(run.frames.size(), 3u);
  EXPECT_THAT(run.fault, AllOf(HasSubstr("4 time stamps"), HasSubstr("only 3 frames")));
}

TEST(FileCameraBadInput, StampsOfATruncatedVideoAreAcceptedWhenTheyMatchItsFrames) {
  const auto folder = fresh_folder();
  write_clip(folder / "clip.avi", {.n_frames = 100});
  test_support::keep_first_bytes(folder / "clip.avi", 0.5);
  const std::size_t n_left = run_through(folder / "clip.avi").frames.size();
  std::vector<double> times_s;
  for (std::size_t i = 0; i < n_left; ++i) times_s.push_back(0.05 * static_cast<double>(i));
  write_timestamps(folder / "clip.timestamps.csv", times_s);
  const Drained run = run_through(folder / "clip.avi");
  EXPECT_EQ(run.last, CaptureStatus::kEndOfStream);
  EXPECT_EQ(run.frames.size(), n_left);
  EXPECT_THAT(run.fault, IsEmpty());
}

TEST(FileCameraBadInput, TimeStampsThatGiveNoRate) {
  const auto folder = fresh_folder();
  write_clip(folder / "clip.avi", {.n_frames = 1});
  write_timestamps(folder / "clip.timestamps.csv", {0.5});
  EXPECT_THAT(refusal(folder / "clip.avi"), HasSubstr("camera.rate_hz"));
  EXPECT_EQ(refusal(folder / "clip.avi", {.rate_hz = 25.0}), "accepted");
}

TEST(FileCameraBadInput, BlackAndSaturatedImagesAreLegalHere) {
  const auto folder = fresh_folder();
  for (const int level : {0, 255}) {
    const auto images = folder / std::to_string(level);
    std::filesystem::create_directories(images);
    write_image(images / "0.png", cv::Mat(48, 64, CV_8UC1, cv::Scalar(level)));
    EXPECT_EQ(run_through(images, 10.0).frames.size(), 1u);
  }
}

}  // namespace
}  // namespace drivers
