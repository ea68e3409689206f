// What is refused, and how: every row runs the real service on one bad input. It must end by itself with the exit code
// of the row, name the culprit and a remedy, and leave no result that holds NaN.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <ostream>

#include "tests/support/pipeline_run.h"
#include "tests/support/service_run.h"
#include "tests/support/swaying_clip.h"

namespace {

namespace fs = std::filesystem;
using test_support::write_image;
using tests::swaying_image;
using tests::write_images;
using tests::write_swaying_clip;

constexpr int kFrames = 100;
constexpr const char* kGoodRegions = "[{name: roof, rect: [20, 20, 80, 50]}]";

// What the service is given; empty fields get something good.
struct Input {
  std::string source;
  std::string camera = "rate_hz: 25";
  std::string regions = kGoodRegions;
  std::string rest;                      // further sections
  std::vector<std::string> arguments;
  std::vector<std::string> before;       // a program that starts the service
};

struct BadInput {
  std::string name;
  std::function<Input(const fs::path& folder)> make;
  int code;
  std::vector<std::string> says;  // each must be in the output
};

std::ostream& operator<<(std::ostream& out, const BadInput& row) { return out << row.name; }

Input clip(const fs::path& folder, int n_frames = kFrames, const char* name = "clip.avi") {
  write_swaying_clip(folder / name, n_frames);
  return {.source = (folder / name).string(), .rest = {}, .arguments = {}, .before = {}};
}

Input good(const fs::path& folder) { return clip(folder, 40); }

Input with_regions(const fs::path& folder, const std::string& regions) {
  Input input = good(folder);
  input.regions = regions;
  return input;
}

Input with_rest(const fs::path& folder, const std::string& rest) {
  Input input = good(folder);
  input.rest = rest + "\n";
  return input;
}

Input with_arguments(const fs::path& folder, const std::vector<std::string>& arguments) {
  Input input = good(folder);
  input.arguments = arguments;
  return input;
}

Input file_of(const fs::path& folder, const char* name, const std::string& bytes) {
  test_support::write_text(folder / name, bytes);
  return {.source = (folder / name).string(), .rest = {}, .arguments = {}, .before = {}};
}

template <class Make>
Input images(const fs::path& folder, Make make) {
  write_images(folder / "images", kFrames, make);
  return {.source = (folder / "images").string(), .rest = {}, .arguments = {}, .before = {}};
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

cv::Mat of_type(int frame, int type) {
  cv::Mat image;
  swaying_image(frame).convertTo(image, CV_MAT_DEPTH(type), CV_MAT_DEPTH(type) == CV_16U ? 257.0 : 1.0);
  if (CV_MAT_CN(type) == 4) cv::cvtColor(image, image, cv::COLOR_GRAY2BGRA);
  return image;
}

// Root may read and write everything unless it gives that right up.
std::vector<std::string> without_file_rights() {
  if (geteuid() != 0) return {};
  return {"/usr/bin/setpriv", "--bounding-set=-dac_override,-dac_read_search", "--inh-caps=-dac_override,-dac_read_search"};
}

Input unreadable(const fs::path& folder) {
  Input input = good(folder);
  fs::permissions(input.source, fs::perms::none);
  input.before = without_file_rights();
  return input;
}

Input not_writable(const fs::path& folder) {
  Input input = good(folder);
  fs::create_directories(folder / "locked");
  fs::permissions(folder / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  input.arguments = {"--report", (folder / "locked").string()};
  input.before = without_file_rights();
  return input;
}

Input disk_full(const fs::path& folder, int n_bytes) {
  Input input = clip(folder);
  input.before = {"/usr/bin/prlimit", "--fsize=" + std::to_string(n_bytes)};
  return input;
}

const std::vector<BadInput>& source_rows() {
  static const std::vector<BadInput> rows{
      {"Missing", [](const fs::path& f) { return Input{.source = (f / "none.mp4").string(), .rest = {}, .arguments = {}, .before = {}}; },
       3, {"none.mp4", "no such file"}},
      {"Unreadable", unreadable, 1, {"clip.avi", "no permission"}},
      {"Empty", [](const fs::path& f) { return file_of(f, "empty.mp4", ""); }, 1, {"empty.mp4", "0 bytes"}},
      {"NotAVideo", [](const fs::path& f) { return file_of(f, "letter.mp4", std::string(5000, 'a')); }, 1, {"letter.mp4", "not a video"}},
      {"CutHeader",
       [](const fs::path& f) {
         Input input = clip(f, kFrames, "clip.mp4");
         fs::resize_file(input.source, 24);
         return input;
       },
       1, {"clip.mp4"}},
      {"CutBeforeItsIndex",
       [](const fs::path& f) {
         Input input = clip(f, kFrames, "clip.mp4");
         test_support::keep_first_bytes(input.source, 0.5);
         return input;
       },
       1, {"clip.mp4", "cut off"}},
      // What decodes is worth having; the loss is told.
      {"CutInTheMiddle",
       [](const fs::path& f) {
         Input input = clip(f);
         test_support::keep_first_bytes(input.source, 0.6);
         return input;
       },
       0, {"clip.avi", "promises 100 frames", "truncated"}},
      {"CutShorterThanOneSegment",
       [](const fs::path& f) {
         Input input = clip(f);
         test_support::keep_first_bytes(input.source, 0.25);
         return input;
       },
       0, {"truncated", "fewer than one segment of 32", "1.3 s"}},
      {"OnePixel", [](const fs::path& f) { return images(f, [](int) { return cv::Mat(1, 1, CV_8UC1, cv::Scalar(9)); }); }, 1, {"1 x 1", "32 x 32"}},
      {"Black", [](const fs::path& f) { return level(f, 0); }, 2, {"roof", "0 corners", "black"}},
      {"Saturated", [](const fs::path& f) { return level(f, 255); }, 2, {"roof", "0 corners", "saturated"}},
      {"SixteenBitImages", [](const fs::path& f) { return images(f, [](int k) { return of_type(k, CV_16UC1); }); }, 1, {"frame_000.png", "16 bits", "8"}},
      {"AlphaImages", [](const fs::path& f) { return images(f, [](int k) { return of_type(k, CV_8UC4); }); }, 1, {"frame_000.png", "alpha"}},
      {"SixteenBitVideo",
       [](const fs::path& f) {
         return file_of(f, "deep.video", test_support::image_stream(".png", {of_type(0, CV_16UC1), of_type(1, CV_16UC1)}));
       },
       1, {"deep.video", "16 bit"}},
      {"AlphaVideo",
       [](const fs::path& f) {
         return file_of(f, "glass.video", test_support::image_stream(".png", {of_type(0, CV_8UC4), of_type(1, CV_8UC4)}));
       },
       1, {"glass.video", "alpha"}},
      {"FolderOfMixedSizes",
       [](const fs::path& f) {
         return images(f, [](int k) { return k == 60 ? swaying_image(k, 96, 128) : swaying_image(k); });
       },
       1, {"frame_060.png", "96 x 128"}},
      {"EmptyFolder",
       [](const fs::path& f) {
         fs::create_directories(f / "images");
         return Input{.source = (f / "images").string(), .rest = {}, .arguments = {}, .before = {}};
       },
       1, {"images", "no image"}},
      {"ShorterThanOneSegment", [](const fs::path& f) { return clip(f, 20); }, 2, {"20 frames", "segment", "1.3 s"}},
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
       0, {"100 frames in = 100 processed"}},
      {"HundredThousandFramesPerSecond",
       [](const fs::path& f) {
         Input input = clip(f);
         input.camera = "rate_hz: 1.0e+5";
         return input;
       },
       0, {"100 frames in = 100 processed"}},
      {"FewerStampsThanFrames", [](const fs::path& f) { return stamped(f, 60, [](int i) { return 0.04 * i; }); }, 1,
       {"clip.timestamps.csv", "60 time stamps for 100 frames", "one line per frame"}},
      {"RepeatedStamp", [](const fs::path& f) { return stamped(f, kFrames, [](int i) { return 0.04 * (i == 50 ? 49 : i); }); }, 1,
       {"clip.timestamps.csv", "52"}},
      {"BackwardStamp", [](const fs::path& f) { return stamped(f, kFrames, [](int i) { return 0.04 * (i == 50 ? 20 : i); }); }, 1,
       {"clip.timestamps.csv", "52"}},
      {"StampsThatAreNoNumbers",
       [](const fs::path& f) {
         Input input = clip(f);
         test_support::write_text(f / "clip.timestamps.csv", "frame,t_s\n0,nan\n1,0.04\n");
         return input;
       },
       1, {"clip.timestamps.csv", "nan"}},
      {"RateZero",
       [](const fs::path& f) {
         Input input = good(f);
         input.camera = "rate_hz: 0";
         return input;
       },
       2, {"config.yaml:1", "camera.rate_hz", "0 is refused", "0.001"}},
      {"RateNaN",
       [](const fs::path& f) {
         Input input = good(f);
         input.camera = "rate_hz: .nan";
         return input;
       },
       2, {"config.yaml:1", "camera.rate_hz", "nan"}},
      {"RateNegative",
       [](const fs::path& f) {
         Input input = good(f);
         input.camera = "rate_hz: -25";
         return input;
       },
       2, {"camera.rate_hz", "-25"}},
  };
  return rows;
}

const std::vector<BadInput>& configuration_rows() {
  static const std::vector<BadInput> rows{
      {"NoRegions", [](const fs::path& f) { return with_regions(f, "[]"); }, 2, {"regions", "1 or more"}},
      {"RegionOutsideTheImage", [](const fs::path& f) { return with_regions(f, "[{name: roof, rect: [100, 20, 80, 50]}]"); }, 2,
       {"roof", "128 x 96", "x = 180"}},
      {"RegionFarOutsideTheImage", [](const fs::path& f) { return with_regions(f, "[{name: roof, rect: [5000, 20, 80, 50]}]"); }, 2,
       {"roof", "128 x 96"}},
      {"RegionTooSmallForCorners", [](const fs::path& f) { return with_regions(f, "[{name: roof, rect: [20, 20, 1, 1]}]"); }, 2,
       {"roof", "corners", "enlarge"}},
      {"TwoRegionsOfOneName",
       [](const fs::path& f) { return with_regions(f, "[{name: roof, rect: [20, 20, 40, 50]}, {name: roof, rect: [60, 20, 40, 50]}]"); }, 2,
       {"roof", "taken", "rename"}},
      {"RegionOfNaN", [](const fs::path& f) { return with_regions(f, "[{name: roof, rect: [.nan, 20, 80, 50]}]"); }, 2, {"regions.0.rect", "nan"}},
      {"ScaleEndsOnOnePixel",
       [](const fs::path& f) { return with_rest(f, "scale: {known_length_mm: 100, from: [20, 30], to: [20, 30]}"); }, 2,
       {"scale.to", "two ends"}},
      {"KnownLengthZero",
       [](const fs::path& f) { return with_rest(f, "scale: {known_length_mm: 0, from: [20, 30], to: [20, 60]}"); }, 2,
       {"scale.known_length_mm", "0 is refused"}},
      {"ScaleOutsideTheImage",
       [](const fs::path& f) { return with_rest(f, "scale: {known_length_mm: 9, from: [20, 30], to: [20, 600]}"); }, 2,
       {"scale.to", "128 x 96"}},
      {"UnknownKey", [](const fs::path& f) { return with_rest(f, "spectrumm: {segment: 32}"); }, 2, {"config.yaml:", "spectrumm"}},
      {"DuplicateKey", [](const fs::path& f) { return with_rest(f, "method: paper\nmethod: paper"); }, 2, {"config.yaml:", "method"}},
  };
  return rows;
}

const std::vector<BadInput>& output_rows() {
  static const std::vector<BadInput> rows{
      {"LcmUrlThatIsNone", [](const fs::path& f) { return with_arguments(f, {"--set", "telemetry.lcm_url=carrier-pigeon"}); }, 2,
       {"carrier-pigeon", "udpm://"}},
      {"LcmUrlWithoutMulticast", [](const fs::path& f) { return with_arguments(f, {"--set", "telemetry.lcm_url=udpm://10.0.0.1:7667"}); }, 2,
       {"10.0.0.1", "multicast"}},
      {"LcmLogInNoFolder",
       [](const fs::path& f) { return with_arguments(f, {"--set", "telemetry.log_file=" + (f / "none" / "run.lcm").string()}); }, 1,
       {"run.lcm", "telemetry.log_file"}},
      {"OutputFolderIsAFile",
       [](const fs::path& f) {
         test_support::write_text(f / "taken", "x");
         return with_arguments(f, {"--report", (f / "taken").string()});
       },
       1, {"taken", "is a file", "another folder"}},
      {"OutputFolderBelowAFile",
       [](const fs::path& f) {
         test_support::write_text(f / "taken", "x");
         return with_arguments(f, {"--report", (f / "taken" / "out").string()});
       },
       1, {"taken", "may be written"}},
      {"OutputFolderNotWritable", not_writable, 1, {"locked", "permission"}},
      {"DiskFullDuringTheReport", [](const fs::path& f) { return disk_full(f, 20000); }, 1,
       {"tracks.csv", "too large", "Free space", "100 frames in = 100 processed"}},
      {"DiskFullFromTheFirstByte", [](const fs::path& f) { return disk_full(f, 0); }, 1, {"modal.json", "tracks.csv", "displacements.csv", "Free space"}},
  };
  return rows;
}

class BadInputs : public ::testing::TestWithParam<BadInput> {
 protected:
  ~BadInputs() override {  // what a row locked is given back, so that the folder can be made anew
    std::error_code ignored;
    fs::permissions(folder_ / "locked", fs::perms::owner_all, ignored);
  }
  fs::path folder_ = tests::own_folder();
};

std::string configuration(const Input& input) {
  return "camera: {source: '" + input.source + "', " + input.camera + "}\nregions: " + input.regions + "\n" + input.rest +
         "spectrum: {segment: 32}\ntelemetry: {lcm_url: ''}\n";
}

bool has_word(const std::string& text, const std::string& word) {
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
    const auto is_letter = [&](std::size_t i) { return i < text.size() && std::isalpha(static_cast<unsigned char>(text[i])) != 0; };
    if (!is_letter(at + word.size()) && (at == 0 || !is_letter(at - 1))) return true;
  }
  return false;
}

void expect_no_nan(const fs::path& folder) {
  if (!fs::exists(folder)) return;
  for (const auto& file : fs::recursive_directory_iterator(folder)) {
    const auto extension = file.path().extension();
    if (extension != ".json" && extension != ".csv") continue;
    const std::string text = tests::file_text(file.path());
    for (const char* word : {"nan", "NaN", "inf", "Infinity"}) EXPECT_FALSE(has_word(text, word)) << file.path() << ": " << word;
    if (extension == ".json") EXPECT_TRUE(tests::json_of(file.path()).is_object()) << file.path();
  }
}

TEST_P(BadInputs, EndsWithItsExitCodeAndSaysWhatToDo) {
  const BadInput& row = GetParam();
  const Input input = row.make(folder_);
  for (const std::string& program : input.before) {
    if (program.front() == '/' && !fs::exists(program)) GTEST_SKIP() << "needs " << program << " (util-linux)";
  }
  tests::write_text_file(folder_ / "config.yaml", configuration(input));
  std::vector<std::string> arguments{"--config", (folder_ / "config.yaml").string(), "--report", (folder_ / "report").string()};
  if (std::find(input.arguments.begin(), input.arguments.end(), "--report") != input.arguments.end()) arguments.resize(2);
  arguments.insert(arguments.end(), input.arguments.begin(), input.arguments.end());
  const tests::ServiceRun run = tests::run_service(arguments, input.before, 60);
  EXPECT_EQ(run.code, row.code) << run.output;
  for (const std::string& text : row.says) EXPECT_THAT(run.output, ::testing::HasSubstr(text));
  expect_no_nan(folder_ / "report");
  if (row.code == 2) EXPECT_FALSE(fs::exists(folder_ / "report" / "modal.json"));
}

std::string name_of(const ::testing::TestParamInfo<BadInput>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Source, BadInputs, ::testing::ValuesIn(source_rows()), name_of);
INSTANTIATE_TEST_SUITE_P(Times, BadInputs, ::testing::ValuesIn(time_rows()), name_of);
INSTANTIATE_TEST_SUITE_P(Configuration, BadInputs, ::testing::ValuesIn(configuration_rows()), name_of);
INSTANTIATE_TEST_SUITE_P(Output, BadInputs, ::testing::ValuesIn(output_rows()), name_of);

}  // namespace
