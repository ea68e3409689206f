#include "tests/support/bad_input.h"
#include "tests/support/ffmpeg_clip.h"

namespace {

using namespace tests::bad_input;
using tests::swaying_image;
using tests::swaying_image_of;
using tests::write_images;

Input file_of(const fs::path& folder, const char* name, const std::string& bytes) {
  test_support::write_text(folder / name, bytes);
  return from(folder / name);
}

template <class Make>
Input images(const fs::path& folder, Make make) {
  write_images(folder / "images", kFrames, make);
  return from(folder / "images");
}

Input level(const fs::path& folder, double grey) {
  return images(folder, [&](int) { return cv::Mat(96, 128, CV_8UC1, cv::Scalar(grey)); });
}

template <class Time>
Input stamped(const fs::path& folder, int n_stamps, Time time_s) {
  Input input = clip(folder);
  std::vector<double> times_s;
  for (int i = 0; i < n_stamps; ++i) times_s.push_back(time_s(i));
  test_support::write_timestamps(folder / "clip.timestamps.csv", times_s);
  return input;
}

// A PNG that states this size; both numbers below 65536.
Input claimed_size(const fs::path& folder, int width_px, int height_px) {
  Input input = images(folder, [](int k) { return swaying_image(k); });
  for (const auto& file : fs::directory_iterator(folder / "images")) {
    std::string bytes = test_support::read_bytes(file.path());
    const std::size_t header = bytes.find("IHDR") + 4;
    for (const auto& [at, value] : {std::pair{header, width_px}, std::pair{header + 4, height_px}}) {
      bytes.replace(at, 4, {'\0', '\0', static_cast<char>(value / 256), static_cast<char>(value % 256)});
    }
    test_support::write_text(file.path(), bytes);
  }
  return input;
}

Input unreadable(const fs::path& folder) {
  Input input = good(folder);
  fs::permissions(input.source, fs::perms::none);
  input.before = without_file_rights();
  return input;
}

const std::vector<BadInput>& source_rows() {
  static const std::vector<BadInput> rows{
      {"Missing", [](const fs::path& f) { return from(f / "none.mp4"); }, 3, {"none.mp4", "no such file"}},
      {"Unreadable", unreadable, 1, {"clip.avi", "no permission"}},
      {"Empty", [](const fs::path& f) { return file_of(f, "empty.mp4", ""); }, 1, {"empty.mp4", "0 bytes"}},
      {"NotAVideo",
       [](const fs::path& f) { return file_of(f, "letter.mp4", std::string(5000, 'a')); },
       1,
       {"letter.mp4", "not a video"}},
      {"CutHeader",
       [](const fs::path& f) {
         Input input = clip(f, kFrames, "clip.mp4");
         fs::resize_file(input.source, 24);
         return input;
       },
       1,
       {"clip.mp4"}},
      {"CutBeforeItsIndex",
       [](const fs::path& f) {
         Input input = clip(f, kFrames, "clip.mp4");
         test_support::keep_first_bytes(input.source, 0.5);
         return input;
       },
       1,
       {"clip.mp4", "cut off"}},
      // Decodable frames are kept; the loss is reported.
      {"CutInTheMiddle",
       [](const fs::path& f) {
         Input input = clip(f);
         test_support::keep_first_bytes(input.source, 0.6);
         return input;
       },
       0,
       {"clip.avi", "promises 100 frames", "truncated"}},
      {"CutShorterThanOneSegment",
       [](const fs::path& f) {
         Input input = clip(f);
         test_support::keep_first_bytes(input.source, 0.25);
         return input;
       },
       2,
       {"spectrum.segment", "fewer than one segment of 32", "1.3 s"}},
      {"OnePixel",
       [](const fs::path& f) { return images(f, [](int) { return cv::Mat(1, 1, CV_8UC1, cv::Scalar(9)); }); },
       1,
       {"1 x 1", "32 x 32"}},
      {"ZeroSize", [](const fs::path& f) { return claimed_size(f, 0, 0); }, 1, {"frame_000.png", "cannot be decoded"}},
      {"ZeroHeight",
       [](const fs::path& f) { return claimed_size(f, 128, 0); },
       1,
       {"frame_000.png", "cannot be decoded"}},
      {"AbsurdSize",
       [](const fs::path& f) { return claimed_size(f, 65535, 65535); },
       1,
       {"frame_000.png", "65535 x 65535 pixels", "8192 x 8192"}},
      {"Black", [](const fs::path& f) { return level(f, 0); }, 2, {"roof", "0 corners", "black"}},
      {"Saturated", [](const fs::path& f) { return level(f, 255); }, 2, {"roof", "0 corners", "saturated"}},
      {"SixteenBitImages",
       [](const fs::path& f) { return images(f, [](int k) { return swaying_image_of(CV_16UC1, k); }); },
       1,
       {"frame_000.png", "16 bits"}},
      {"AlphaImages",
       [](const fs::path& f) { return images(f, [](int k) { return swaying_image_of(CV_8UC4, k); }); },
       1,
       {"frame_000.png", "alpha"}},
      {"SixteenBitVideo",
       [](const fs::path& f) {
         return file_of(
             f, "deep.video",
             test_support::image_stream(".png", {swaying_image_of(CV_16UC1, 0), swaying_image_of(CV_16UC1, 1)}));
       },
       1,
       {"deep.video", "16 bit"}},
      {"AlphaVideo",
       [](const fs::path& f) {
         return file_of(
             f, "glass.video",
             test_support::image_stream(".png", {swaying_image_of(CV_8UC4, 0), swaying_image_of(CV_8UC4, 1)}));
       },
       1,
       {"glass.video", "alpha"}},
      {"FolderOfMixedSizes",
       [](const fs::path& f) {
         return images(f, [](int k) { return k == 60 ? swaying_image(k, 96, 128) : swaying_image(k); });
       },
       1,
       {"frame_060.png", "96 x 128"}},
      {"EmptyFolder",
       [](const fs::path& f) {
         fs::create_directories(f / "images");
         return from(f / "images");
       },
       1,
       {"images", "no image"}},
      {"ShorterThanOneSegment", [](const fs::path& f) { return clip(f, 20); }, 2, {"20 frames", "segment", "1.3 s"}},
  };
  return rows;
}

// Files made by ffmpeg: with other streams beside a video, and without any video.
Input made_by_ffmpeg(const fs::path& folder, const char* name, const std::string& arguments) {
  clip(folder);
  test_support::ffmpeg(fmt::format("-i {} {} {}", test_support::quoted(folder / "clip.avi"), arguments,
                                   test_support::quoted(folder / name)));
  return from(folder / name);
}

const std::vector<BadInput>& stream_rows() {
  static const std::vector<BadInput> rows{
      {"AudioOnly",
       [](const fs::path& f) {
         test_support::ffmpeg("-f lavfi -i sine=d=2 -c:a aac " + test_support::quoted(f / "sound.mp4"));
         return from(f / "sound.mp4");
       },
       1,
       {"sound.mp4", "no moving picture", "audio aac", "camera.source"}},
      {"SoundWithACoverOnly",
       [](const fs::path& f) {
         test_support::ffmpeg("-f lavfi -i testsrc2=s=320x240:d=1 -frames:v 1 " +
                              test_support::quoted(f / "cover.jpg"));
         test_support::ffmpeg(
             fmt::format("-f lavfi -i sine=d=2 -i {} -map 0 -map 1 -c:a aac -c:v copy "
                         "-disposition:v:0 attached_pic {}",
                         test_support::quoted(f / "cover.jpg"), test_support::quoted(f / "song.mp4")));
         return from(f / "song.mp4");
       },
       1,
       {"song.mp4", "no moving picture", "a cover picture"}},
      {"ACoverBeforeTheFilm",
       [](const fs::path& f) {
         test_support::ffmpeg("-f lavfi -i testsrc2=s=640x480:d=1 -frames:v 1 " +
                              test_support::quoted(f / "cover.jpg"));
         return made_by_ffmpeg(f, "covered.mp4",
                               fmt::format("-i {} -map 1 -map 0:v -c:v:0 copy -c:v:1 libx264 -crf 10 "
                                           "-disposition:v:0 attached_pic",
                                           test_support::quoted(f / "cover.jpg")));
       },
       0,
       {"100 frames in = 100 processed"}},
      {"AnAttachment",
       [](const fs::path& f) {
         test_support::write_text(f / "font.ttf", std::string(3000, 'x'));
         return made_by_ffmpeg(f, "attached.mkv",
                               fmt::format("-map 0:v -c:v libx264 -crf 10 -attach {} -metadata:s:t "
                                           "mimetype=application/x-truetype-font",
                                           test_support::quoted(f / "font.ttf")));
       },
       0,
       {"attachment", "100 frames in = 100 processed"}},
      {"Encrypted",
       [](const fs::path& f) {
         return made_by_ffmpeg(f, "locked.mp4",
                               "-map 0:v -c:v libx264 -crf 10 -encryption_scheme cenc-aes-ctr -encryption_key "
                               "76a6c65c5ea762046bd749a2e632ccbb -encryption_kid a7e61c373e219033c21091fa607bf3b8");
       },
       1,
       {"locked.mp4", "encrypted", "decrypt it first"}},
      {"StillBeingRecorded",  // an MP4 has its index at the end
       [](const fs::path& f) {
         Input input = made_by_ffmpeg(f, "growing.mp4", "-map 0:v -c:v libx264 -crf 10");
         test_support::keep_first_bytes(input.source, 0.9);
         return input;
       },
       1,
       {"growing.mp4", "index is missing"}},
  };
  return rows;
}

const std::vector<BadInput>& time_rows() {
  static const std::vector<BadInput> rows{
      {"OneFramePerSecond",
       [](const fs::path& f) {
         Input input = clip(f);
         input.camera = "rate_hz: 1";
         return input;
       },
       0,
       {"100 frames in = 100 processed"}},
      {"HundredThousandFramesPerSecond",
       [](const fs::path& f) {
         Input input = clip(f);
         input.camera = "rate_hz: 1.0e+5";
         return input;
       },
       0,
       {"100 frames in = 100 processed"}},
      {"FewerStampsThanFrames",
       [](const fs::path& f) { return stamped(f, 60, [](int i) { return 0.04 * i; }); },
       1,
       {"clip.timestamps.csv", "60 time stamps for 100 frames", "one line per frame"}},
      {"RepeatedStamp",
       [](const fs::path& f) { return stamped(f, kFrames, [](int i) { return 0.04 * (i == 50 ? 49 : i); }); },
       1,
       {"clip.timestamps.csv:52"}},
      {"BackwardStamp",
       [](const fs::path& f) { return stamped(f, kFrames, [](int i) { return 0.04 * (i == 50 ? 20 : i); }); },
       1,
       {"clip.timestamps.csv:52"}},
      {"StampsThatAreNoNumbers",
       [](const fs::path& f) {
         Input input = clip(f);
         test_support::write_text(f / "clip.timestamps.csv", "frame,t_s\n0,nan\n1,0.04\n");
         return input;
       },
       1,
       {"clip.timestamps.csv", "nan"}},
      {"RateZero",
       [](const fs::path& f) {
         Input input = good(f);
         input.camera = "rate_hz: 0";
         return input;
       },
       2,
       {"config.yaml:1", "camera.rate_hz", "0 is refused", "0.001"}},
      {"RateNaN",
       [](const fs::path& f) {
         Input input = good(f);
         input.camera = "rate_hz: .nan";
         return input;
       },
       2,
       {"config.yaml:1", "camera.rate_hz", "nan"}},
      {"RateNegative",
       [](const fs::path& f) {
         Input input = good(f);
         input.camera = "rate_hz: -25";
         return input;
       },
       2,
       {"camera.rate_hz", "-25"}},
  };
  return rows;
}

class BadSource : public ::testing::TestWithParam<BadInput> {};

TEST_P(BadSource, EndsWithItsExitCodeAndSaysWhatToDo) { expect_as_told(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Pictures, BadSource, ::testing::ValuesIn(source_rows()), name_of);
INSTANTIATE_TEST_SUITE_P(Streams, BadSource, ::testing::ValuesIn(stream_rows()), name_of);
INSTANTIATE_TEST_SUITE_P(Times, BadSource, ::testing::ValuesIn(time_rows()), name_of);

}  // namespace
