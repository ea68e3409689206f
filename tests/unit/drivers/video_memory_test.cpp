// Videos that would take more memory to decode than is allowed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/camera/recording/file_camera.h"
#include "drivers/camera/recording/video_decoder.h"
#include "tests/support/camera_drain.h"
#include "tests/support/ffmpeg_clip.h"
#include "tests/support/refused_clip.h"
#include "tests/support/test_clip.h"

namespace drivers {
namespace {

using test_support::drain;
using test_support::ffmpeg;
using test_support::fresh_folder;
using test_support::noisy_film;
using test_support::quoted;
using test_support::refusal;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::vector<std::vector<std::uint8_t>> pictures(const std::filesystem::path& clip, int most_mb) {
  std::vector<std::vector<std::uint8_t>> out;
  VideoDecoder decoder(clip.string(), most_mb);
  for (DecodeStatus status = decoder.next(); status != DecodeStatus::kEnd; status = decoder.next()) {
    EXPECT_EQ(status, DecodeStatus::kPicture);
    const AVFrame& picture = decoder.picture();
    out.emplace_back();
    for (int v = 0; v < picture.height; ++v) {
      const std::uint8_t* row = picture.data[0] + std::ptrdiff_t{v} * picture.linesize[0];
      out.back().insert(out.back().end(), row, row + picture.width);
    }
  }
  EXPECT_EQ(decoder.fault(), "");
  return out;
}

// 1280 x 720: 1.94 MB a picture with what lies beside it.
TEST(VideoMemory, RefusesReferencePicturesThatDoNotFit) {
  const auto clip = fresh_folder() / "references.mp4";
  ffmpeg(fmt::format("{} -c:v libx264 -preset ultrafast -x264-params ref=16:bframes=0 {}",
                     noisy_film(30, 25.0, "1280x720"), quoted(clip)));
  EXPECT_THAT(refusal(clip, {.decoder_mb = 20}), AllOf(HasSubstr("references.mp4"), HasSubstr("1280 x 720"),
                                                       HasSubstr("camera.decoder_mb: 20"), HasSubstr("ffmpeg -i IN")));
  EXPECT_EQ(refusal(clip, {.decoder_mb = 36}), "accepted");
}

TEST(VideoMemory, RefusesAPictureThatDoesNotFit) {
  const auto clip = fresh_folder() / "large.mp4";
  ffmpeg(fmt::format("{} -c:v libx264 -preset ultrafast {}", noisy_film(3, 25.0, "2560x2048"), quoted(clip)));
  EXPECT_THAT(refusal(clip, {.decoder_mb = 20}), AllOf(HasSubstr("2560 x 2048"), HasSubstr("23 MB or more")));
}

TEST(VideoMemory, RefusesReferencePicturesOfHevcThatDoNotFit) {
  for (const char* name : {"references.mp4", "references.ts"}) {
    const auto clip = fresh_folder() / name;
    ffmpeg(fmt::format("{} -c:v libx265 -preset ultrafast -x265-params ref=8:bframes=0:log-level=none {}",
                       noisy_film(12, 25.0, "1600x912"), quoted(clip)));
    EXPECT_THAT(refusal(clip, {.decoder_mb = 20}),
                AllOf(HasSubstr(name), HasSubstr("1600 x 9"), HasSubstr("camera.decoder_mb: 20")));
    EXPECT_EQ(refusal(clip, {.decoder_mb = 60}), "accepted");
  }
}

TEST(VideoMemory, EndsWithAFaultWhereMoreArePredictedFromInMidStream) {
  const auto folder = fresh_folder();
  std::string bytes;
  for (const int n_references : {1, 16}) {
    const auto part = folder / fmt::format("{}.h264", n_references);
    ffmpeg(fmt::format("{} -c:v libx264 -preset ultrafast -x264-params ref={}:bframes=0 -f h264 {}",
                       noisy_film(20, 25.0, "1280x720"), n_references, quoted(part)));
    bytes += test_support::read_bytes(part);
  }
  const auto clip = folder / "joined.h264";
  test_support::write_text(clip, bytes);
  FileCamera camera({.source = clip.string(), .rate_hz = 25.0, .decoder_mb = 20});
  camera.start();
  const auto run = drain(camera);
  EXPECT_EQ(run.last, CaptureStatus::kFault);
  EXPECT_GE(run.frames.size(), 15U);
  EXPECT_LE(run.frames.size(), 20U);
  EXPECT_THAT(run.fault, AllOf(HasSubstr("joined.h264"), HasSubstr("camera.decoder_mb: 20")));
}

// Above the size that libavformat itself decodes; its pictures are shown in another order than they are stored.
TEST(VideoMemory, ThePicturesDoNotDependOnTheBound) {
  const auto clip = fresh_folder() / "same.mp4";
  ffmpeg(fmt::format("{} -c:v libx264 -preset veryfast -bf 3 -refs 3 {}", noisy_film(24, 25.0, "2048x1216"),
                     quoted(clip)));
  const auto little = pictures(clip, 27), much = pictures(clip, 1000);
  EXPECT_EQ(much.size(), 24U);
  EXPECT_EQ(little, much);
}

}  // namespace
}  // namespace drivers
