// Files as made by phones, action cameras and editors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "drivers/camera/recording/file_camera.h"
#include "tests/support/camera_drain.h"
#include "tests/support/ffmpeg_clip.h"
#include "tests/support/refused_clip.h"
#include "tests/support/test_clip.h"

namespace drivers {
namespace {

using test_support::drain;
using test_support::Drained;
using test_support::ffmpeg;
using test_support::fresh_folder;
using test_support::kH264;
using test_support::noisy_film;
using test_support::quoted;
using test_support::refusal;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Played {
  core::CameraInfo info;
  Drained run;
  core::RecordingTimes times;
  std::uint64_t n_skipped = 0;  // cells of the sequence without a frame, between the first and the last
};

Played play(const std::filesystem::path& clip, double rate_hz = 0.0) {
  FileCamera camera({.source = clip.string(), .rate_hz = rate_hz});
  Played out{camera.info(), {}, {}, 0};
  camera.start();
  out.run = drain(camera);
  out.times = camera.times();
  for (std::size_t i = 1; i < out.run.frames.size(); ++i) {
    out.n_skipped += out.run.frames[i].sequence - out.run.frames[i - 1].sequence - 1;
  }
  return out;
}

void expect_times_on_the_grid(const Played& played) {
  for (const core::Frame& frame : played.run.frames) {
    EXPECT_NEAR(static_cast<double>(frame.t_start_ns) * 1e-9 * played.info.rate_hz, static_cast<double>(frame.sequence),
                1e-3);
  }
}

TEST(FileCameraFootage, DroppedFramesLeaveHolesInTheGrid) {
  const auto clip = fresh_folder() / "dropped.mp4";
  ffmpeg(fmt::format("{} -vf \"select='mod(n*n,13)-1'\" -vsync vfr {} {}", noisy_film(200), kH264, quoted(clip)));
  std::uint64_t n_dropped = 0;  // between the first frame and the last, which are both kept
  for (int n = 0; n < 200; ++n) n_dropped += n * n % 13 == 1 ? 1 : 0;
  const Played played = play(clip);
  EXPECT_DOUBLE_EQ(played.info.rate_hz, 25.0);
  EXPECT_EQ(played.run.frames.size(), 200 - n_dropped);
  EXPECT_EQ(played.times.n_lost, n_dropped);
  EXPECT_EQ(played.n_skipped, n_dropped);
  EXPECT_EQ(played.times.n_repeated, 0U);
  EXPECT_EQ(played.times.n_damaged, 0U);
  expect_times_on_the_grid(played);
}

TEST(FileCameraFootage, EverySeventhFrameGoneIsNoOtherRate) {
  const auto clip = fresh_folder() / "seventh.mp4";
  ffmpeg(fmt::format("{} -vf \"select='mod(n+1,7)'\" -vsync vfr {} {}", noisy_film(141), kH264, quoted(clip)));
  const Played played = play(clip);
  EXPECT_DOUBLE_EQ(played.info.rate_hz, 25.0);
  EXPECT_EQ(played.times.n_lost, 20U);
  EXPECT_EQ(played.run.frames.back().t_start_ns, 140 * 40'000'000LL);
}

TEST(FileCameraFootage, PredictionOfFramesIsKnown) {
  const auto predicted = [](const char* name, const char* coder) {
    const auto clip = fresh_folder() / name;
    ffmpeg(fmt::format("{} {} {}", noisy_film(40), coder, quoted(clip)));
    return play(clip).times.prediction;
  };
  EXPECT_EQ(predicted("past.mp4", "-c:v libx264 -preset fast -bf 0"), core::FramePrediction::kPast);
  EXPECT_EQ(predicted("both.mp4", "-c:v libx264 -preset fast -bf 2 -x264-params b-adapt=0"),
            core::FramePrediction::kBoth);
  EXPECT_EQ(predicted("none.mkv", "-c:v mjpeg -pix_fmt yuvj420p"), core::FramePrediction::kNone);
}

TEST(FileCameraFootage, AGapIsMaskedCells) {
  const auto clip = fresh_folder() / "gap.mkv";  // times in whole milliseconds
  ffmpeg(fmt::format("{} -vf \"select='not(between(n,90,179))'\" -vsync vfr {} {}", noisy_film(300, 30.0), kH264,
                     quoted(clip)));
  const Played played = play(clip);
  EXPECT_NEAR(played.info.rate_hz, 30.0, 1e-3);
  EXPECT_EQ(played.times.n_lost, 90U);
  EXPECT_EQ(played.times.n_gaps, 1U);
  EXPECT_NEAR(played.times.longest_gap_s, 3.0, 0.01);
  EXPECT_EQ(played.run.frames[90].sequence, 180U);
  expect_times_on_the_grid(played);
}

TEST(FileCameraFootage, RepeatedFramesOfARateConversionAreTakenOut) {
  const auto clip = fresh_folder() / "thirty.mp4";
  ffmpeg(fmt::format("{} -vf fps=30 {} {}", noisy_film(250), kH264, quoted(clip)));
  const Played played = play(clip);
  EXPECT_DOUBLE_EQ(played.info.rate_hz, 25.0);
  EXPECT_EQ(played.run.frames.size(), 250U);
  EXPECT_EQ(played.times.n_repeated, 50U);
  EXPECT_EQ(played.n_skipped, 0U);
  EXPECT_THAT(played.times.remark, AllOf(HasSubstr("1 of every 6"), HasSubstr("from 25 to 30")));
  EXPECT_DOUBLE_EQ(play(clip, 25.0).info.rate_hz, 25.0) << "the declared rate is that of the recording";
}

TEST(FileCameraFootage, AFrozenSecondIsNotNew) {
  const auto folder = fresh_folder();
  ffmpeg(fmt::format("{} -vf \"select='not(between(n,101,125))'\" -vsync cfr -r 25 {} {}", noisy_film(250), kH264,
                     quoted(folder / "frozen.mp4")));
  const Played played = play(folder / "frozen.mp4");
  EXPECT_EQ(played.times.n_lost, 0U);
  EXPECT_EQ(played.times.n_repeated, 25U);
  EXPECT_EQ(played.n_skipped, 25U);
  EXPECT_EQ(played.run.frames.size(), 225U);
}

TEST(FileCameraFootage, AStillPictureIsNotRepeats) {
  const auto clip = fresh_folder() / "still.mp4";
  ffmpeg(fmt::format("-f lavfi -i color=gray:s=128x96:r=25:d=4 {} {}", kH264, quoted(clip)));
  const Played played = play(clip);
  EXPECT_EQ(played.run.frames.size(), 100U);
  EXPECT_EQ(played.times.n_repeated, 0U);
}

TEST(FileCameraFootage, ManyPacketsOfAnotherStreamLieBetweenTwoFrames) {
  const auto clip = fresh_folder() / "other_stream.mkv";
  ffmpeg(fmt::format("{} -f lavfi -i sine=r=48000:d=2,asetnsamples=n=2 -map 0 -map 1 -c:a pcm_s16le {} {}",
                     noisy_film(50), kH264, quoted(clip)));
  const Played played = play(clip);  // 960 packets of sound for each frame
  EXPECT_EQ(played.run.frames.size(), 50U);
  EXPECT_THAT(played.run.fault, IsEmpty());
  EXPECT_THAT(played.info.description, HasSubstr("audio pcm_s16le"));
}

TEST(FileCameraFootage, TenBitsAreTheirUpperEight) {
  const auto folder = fresh_folder();
  const auto ramp = [&](const char* format, const char* luma, const char* codec, const char* name) {
    ffmpeg(fmt::format("-f lavfi -i \"nullsrc=s=256x64:r=25:d=0.2,format={},geq=lum='{}':cb=128:cr=128\" {} {}", format,
                       luma, codec, quoted(folder / name)));
    return play(folder / name).run.frames.at(0).pixels;
  };
  const auto eight = ramp("yuv420p", "X", "-c:v ffv1", "eight.mkv");
  const auto ten = ramp("yuv420p10le", "4*X", "-c:v ffv1", "ten.mkv");
  for (std::size_t u = 0; u < 256; ++u) {
    EXPECT_EQ(eight[u], std::clamp((static_cast<int>(u) - 16) * 255 / 219, 0, 255) * (u > 16 ? 1 : 0)) << u;
    EXPECT_NEAR(ten[u], eight[u], 1) << u;
  }
}

TEST(FileCameraFootage, FullRangeLumaIsCopied) {
  const auto folder = fresh_folder();
  ffmpeg(fmt::format("-f lavfi -i \"nullsrc=s=256x64:r=25:d=0.2,format=gray,geq=lum=X\" -f rawvideo -pix_fmt gray {}",
                     quoted(folder / "raw")));
  ffmpeg(
      fmt::format("-f rawvideo -pix_fmt gray -s 256x64 -framerate 25 -color_range pc -i {} -c:v libx264 -qp 0 "
                  "-pix_fmt yuvj420p -color_range pc {}",
                  quoted(folder / "raw"), quoted(folder / "full.mp4")));
  const Played played = play(folder / "full.mp4");
  for (std::size_t u = 0; u < 256; ++u) EXPECT_EQ(played.run.frames.at(0).pixels[u], u);
}

TEST(FileCameraFootage, AChangeOfSizeEndsInWords) {
  const auto folder = fresh_folder();
  ffmpeg(fmt::format("{} {} {}", noisy_film(20), kH264, quoted(folder / "a.ts")));
  ffmpeg(fmt::format("{} {} {}", noisy_film(20, 25.0, "160x96"), kH264, quoted(folder / "b.ts")));
  ffmpeg(fmt::format("-i {} -c copy -f h264 {}", quoted(folder / "a.ts"), quoted(folder / "a.h264")));
  ffmpeg(fmt::format("-i {} -c copy -f h264 {}", quoted(folder / "b.ts"), quoted(folder / "b.h264")));
  test_support::write_text(folder / "both.h264",
                           test_support::read_bytes(folder / "a.h264") + test_support::read_bytes(folder / "b.h264"));
  const Played played = play(folder / "both.h264");
  EXPECT_EQ(played.run.last, CaptureStatus::kFault);
  EXPECT_EQ(played.run.frames.size(), 20U);
  EXPECT_THAT(played.run.fault, AllOf(HasSubstr("160 x 96"), HasSubstr("128 x 96"), HasSubstr("changes its size")));
}

TEST(FileCameraFootage, DamagedPacketsAreCountedOneByOne) {
  const auto clip = fresh_folder() / "damaged.mkv";
  ffmpeg(fmt::format("{} -c:v mjpeg -q:v 3 {}", noisy_film(60), quoted(clip)));
  std::string bytes = test_support::read_bytes(clip);
  std::size_t at = 0;
  for (int frame = 0; frame < 60; ++frame) {
    at = bytes.find("\xFF\xD8\xFF", at + 1);
    ASSERT_NE(at, std::string::npos);
    if (frame == 20 || frame == 21 || frame == 40)
      std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), 400, 'x');
  }
  test_support::write_text(clip, bytes);
  const Played played = play(clip);
  EXPECT_EQ(played.run.frames.size(), 57U);
  EXPECT_EQ(played.times.n_damaged, 3U);
  EXPECT_EQ(played.n_skipped, 3U);
  EXPECT_EQ(played.run.frames[20].sequence, 22U);
}

TEST(FileCameraFootage, WhatIsPredictedFromADamagedFrameIsCounted) {
  const auto clip = fresh_folder() / "predicted.mp4";
  ffmpeg(fmt::format("{} -c:v libx264 -preset veryfast -g 25 -bf 0 -threads 1 {}", noisy_film(75), quoted(clip)));
  std::string bytes = test_support::read_bytes(clip);
  const std::size_t middle = bytes.size() / 2;
  for (std::size_t i = 0; i < 300; ++i) bytes[middle + i] = static_cast<char>(0x55);
  test_support::write_text(clip, bytes);
  const Played played = play(clip);
  EXPECT_GE(played.times.n_damaged, 1U);
  EXPECT_EQ(played.run.frames.size() + played.times.n_damaged, 75U);
  EXPECT_GT(played.times.n_after_damage, 0U);
  EXPECT_LT(played.times.n_after_damage, 25U);
}

TEST(FileCameraFootage, SoundAloneIsNoVideo) {
  const auto clip = fresh_folder() / "sound.mp4";
  ffmpeg("-f lavfi -i sine=d=1 -c:a aac " + quoted(clip));
  EXPECT_THAT(refusal(clip), AllOf(HasSubstr("no moving picture"), HasSubstr("audio aac")));
}

TEST(FileCameraFootage, AFileThatGrowsWhileItIsReadIsSaid) {
  const auto clip = fresh_folder() / "growing.mkv";
  ffmpeg(fmt::format("{} {} {}", noisy_film(50), kH264, quoted(clip)));
  FileCamera camera({.source = clip.string()});
  test_support::write_text(clip, test_support::read_bytes(clip) + std::string(1000, '\0'));
  camera.start();
  const Drained run = drain(camera);
  EXPECT_EQ(run.frames.size(), 50U);
  EXPECT_THAT(run.fault, AllOf(HasSubstr("growing.mkv"), HasSubstr("grew from"), HasSubstr("still being recorded")));
}

TEST(FileCameraFootage, ACoverIsNotTheFilm) {
  const auto folder = fresh_folder();
  ffmpeg(fmt::format("{} -frames:v 1 {}", noisy_film(1, 25.0, "640x480"), quoted(folder / "cover.jpg")));
  ffmpeg(fmt::format("{} {} {}", noisy_film(30), kH264, quoted(folder / "film.mp4")));
  for (const char* marked : {"-disposition:v:0 attached_pic -disposition:v:1 default", "-disposition:v:1 0"}) {
    ffmpeg(fmt::format("-i {} -i {} -map 0 -map 1 -c copy {} {}", quoted(folder / "cover.jpg"),
                       quoted(folder / "film.mp4"), marked, quoted(folder / "both.mp4")));
    const Played played = play(folder / "both.mp4");
    EXPECT_EQ(played.info.width_px, 128) << marked;
    EXPECT_EQ(played.run.frames.size(), 30U) << marked;
  }
}

TEST(FileCameraFootage, JoinedPartsOfTwoRatesAreRefusedInWords) {
  const auto folder = fresh_folder();
  ffmpeg(
      fmt::format("{} -vf \"settb=1/15000,setpts='if(lt(N,150),N/25,6+(N-150)/30)/TB'\" -vsync vfr "
                  "-enc_time_base 1:15000 {} {}",
                  noisy_film(300), kH264, quoted(folder / "joined.mp4")));
  EXPECT_THAT(refusal(folder / "joined.mp4"),
              AllOf(HasSubstr("joined.mp4"), HasSubstr("changes from 25 to 30 Hz"), HasSubstr("cut")));
}

TEST(FileCameraFootage, ADeclaredRateScalesEvenTimesAndTheirGaps) {
  const auto clip = fresh_folder() / "slow.mp4";
  ffmpeg(fmt::format("{} -vf \"select='not(between(n,50,59))'\" -vsync vfr {} {}", noisy_film(100, 50.0), kH264,
                     quoted(clip)));
  const Played played = play(clip, 250.0);
  EXPECT_DOUBLE_EQ(played.info.rate_hz, 250.0);
  EXPECT_EQ(played.run.frames.back().t_start_ns, 99 * 4'000'000LL);
  EXPECT_EQ(played.n_skipped, 10U);
}

TEST(FileCameraFootage, ADeclaredRateThatContradictsUnevenTimesIsRemarkedOn) {
  const auto clip = fresh_folder() / "uneven.mp4";
  ffmpeg(
      fmt::format("{} -vf \"settb=1/90000,setpts='(N/30+0.004*sin(N*N))/TB'\" -vsync vfr -enc_time_base "
                  "1:90000 {} {}",
                  noisy_film(120, 30.0), kH264, quoted(clip)));
  EXPECT_THAT(play(clip).times.remark, IsEmpty());
  EXPECT_NEAR(play(clip).times.jitter_s, 0.004 / std::sqrt(2.0), 5e-4);
  const Played played = play(clip, 240.0);
  EXPECT_DOUBLE_EQ(played.info.rate_hz, 240.0);
  EXPECT_THAT(played.times.remark, AllOf(HasSubstr("240"), HasSubstr("contradicts")));
}

}  // namespace
}  // namespace drivers
