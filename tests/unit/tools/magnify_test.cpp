#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "drivers/storage/clip_writer.h"
#include "drivers/storage/json.h"
#include "tests/support/command.h"
#include "tests/support/folder_test.h"

// `hovermodal magnify` as a user runs it.
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using tests::Outcome;

constexpr int kWidth = 160, kHeight = 120, kFrames = 3000;
constexpr double kMmPerPx = 2.0, kRate_hz = 25.0;

// A run's folder: a roof and a middle that moves half as far, one mode of 2 Hz, 3000 frames; a base whose motion is
// noise; a wall without a channel; and the clip.
class Magnify : public tests::FolderTest {
 protected:
  void SetUp() override {
    tests::FolderTest::SetUp();
    write_displacements();
    write_tracks();
    write_clip();
    const Outcome outcome =
        tests::run("hovermodal", "identify --series " + path("displacements.csv") + " --report " + path("made"));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
    fs::copy_file(path("made") + "/modal.json", path("modal.json"));
  }

  void write_displacements() {
    std::ofstream table(path("displacements.csv"));
    table << "# unit: mm\n# rate_hz: 25\nframe,t_s,scale_mm_per_px,roof,middle,base\n";
    std::mt19937_64 random(7);
    std::normal_distribution<double> gaussian;
    constexpr double kPerFrame = 2.0 * 3.14159265358979 * 2.0 / kRate_hz;
    const double r = std::exp(-0.01 * kPerFrame);
    double y = 0.0, before = 0.0;
    for (int k = 0; k < kFrames; ++k) {
      const double next = 2.0 * r * std::cos(kPerFrame) * y - r * r * before + gaussian(random);
      before = y, y = next;
      squares_ += y * y;
      table << k << ',' << k / kRate_hz << ',' << kMmPerPx << ',' << y + 0.05 * gaussian(random) << ','
            << 0.5 * y + 0.05 * gaussian(random) << ',' << 0.5 * gaussian(random) << '\n';
    }
  }

  // The points of a picture that moves by 2 px a frame.
  void write_tracks(int n_frames = 1) const {
    std::ofstream table(path("tracks.csv"));
    table << "# hovermodal tracks, version 1\n# image_size_px: " << kWidth << " x " << kHeight
          << "\n# rate_hz: 25\n# readout_ms: 0\n"
          << "# readout_direction: down\n# exposure_ms: 0\n# frame_count: " << n_frames
          << "\n# regions: roof,middle,base,wall\nframe,t_s,point,region,u_px,v_px,sigma_px\n";
    for (int k = 0; k < n_frames; ++k) {
      int id = 0;
      for (const auto& [name, u, v] : std::vector<std::tuple<const char*, int, int>>{
               {"roof", 60, 20}, {"middle", 60, 60}, {"base", 60, 102}, {"wall", 20, 60}}) {
        for (int i = 0; i < 3; ++i, ++id)
          table << k << ',' << k / kRate_hz << ',' << id << ',' << name << ',' << u + 8 * (i % 2) + 2 * k << ','
                << v + i << ",0.01\n";
      }
    }
  }

  void write_clip() const {
    std::vector<std::uint8_t> pixels(kWidth * kHeight);
    std::mt19937 random(3);
    for (std::uint8_t& pixel : pixels) pixel = static_cast<std::uint8_t>(random() % 256);
    drivers::ClipWriter writer(path("clip.mp4"), kWidth, kHeight, kRate_hz, 10);
    for (int i = 0; i < 30; ++i) writer.write(pixels.data());
    writer.finish();
  }

  // Waves.
  static double pattern(double u, double v) {
    return 128.0 + 40.0 * std::sin(0.45 * u + 0.3 * v) + 30.0 * std::sin(0.31 * u - 0.53 * v) +
           20.0 * std::sin(0.83 * u);
  }
  void write_panned_clip(int n_frames) const {
    std::vector<std::uint8_t> pixels(kWidth * kHeight);
    drivers::ClipWriter writer(path("clip.mp4"), kWidth, kHeight, kRate_hz, 0);
    for (int k = 0; k < n_frames; ++k) {
      for (int i = 0; i < kWidth * kHeight; ++i)
        pixels[static_cast<std::size_t>(i)] =
            static_cast<std::uint8_t>(std::lround(pattern(i % kWidth - 2.0 * k, 1.0 * (i / kWidth))));
      writer.write(pixels.data());
    }
    writer.finish();
  }
  // By least squares of each frame's patch of the roof against the pattern.
  static std::vector<double> shifts_of_the_roof(const std::string& clip) {
    cv::VideoCapture video(clip);
    std::vector<double> out;
    cv::Mat colour, gray;
    for (int k = 0; video.read(colour); ++k) {
      cv::extractChannel(colour, gray, 1);
      double best = 1e18, best_px = 0.0;
      const double pan_px = 2.0 * k;
      for (double by_px = -12.0; by_px <= 12.0; by_px += 0.05) {
        double error = 0.0;
        for (int v = 15; v <= 25; ++v) {
          for (int u = 58; u <= 70; ++u) {
            const int at = u + static_cast<int>(pan_px);
            error += std::pow(gray.at<std::uint8_t>(v, at) - pattern(at - pan_px - by_px, v), 2);
          }
        }
        if (error < best) best = error, best_px = by_px;
      }
      out.push_back(pan_px + best_px);
    }
    for (std::size_t k = out.size(); k-- > 0;) out[k] -= out[0];
    return out;
  }

  void edit(const std::function<void(nlohmann::ordered_json&)>& change) const {
    nlohmann::ordered_json modal = drivers::read_json_file(path("modal.json"));
    change(modal["modes"][0]);
    std::ofstream(path("modal.json")) << modal.dump();
  }

  void make_base_uncertain() const {
    edit([](nlohmann::ordered_json& mode) { mode["shape_std"]["base"] = 0.5; });
  }

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] Outcome magnified(const std::string& more) const {
    return tests::run("hovermodal", "magnify " + folder_.string() + " --out " + path("mode.mp4") + " " + more);
  }

  double squares_ = 0.0;
};

TEST_F(Magnify, DrawsTheShapeTimesAmplitudeTimesFactor) {
  make_base_uncertain();
  const Outcome outcome = magnified("--mode 1 --factor 0.4 --seconds 2 --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  const auto told = nlohmann::json::parse(outcome.text);
  // Root 2 times the rms, in px of the first frame. The mode's band, 4 zeta f to both sides, holds 2/pi atan(4) of its
  // power.
  const double share = 2.0 / std::numbers::pi * std::atan(4.0);
  const double amplitude_px = std::sqrt(2.0 * share * squares_ / kFrames) / kMmPerPx;
  EXPECT_NEAR(told["amplitude_px"].get<double>() / amplitude_px, 1.0, 0.03);
  EXPECT_NEAR(told["frequency_hz"].get<double>(), 2.0, 0.02);
  ASSERT_EQ(told["regions"].size(), 3U);  // the wall has no channel
  EXPECT_EQ(told["regions"][0]["name"], "roof");
  EXPECT_NEAR(told["regions"][0]["drawn_u_px"][0].get<double>(), 0.4 * told["amplitude_px"].get<double>(), 1e-9);
  EXPECT_NEAR(told["regions"][1]["drawn_u_px"][0].get<double>(), 0.2 * told["amplitude_px"].get<double>(), 0.02);
  EXPECT_EQ(told["regions"][1]["drawn_v_px"][0].get<double>(), 0.0);
  EXPECT_EQ(told["regions"][2]["held"], "this would magnify noise");
  EXPECT_EQ(told["regions"][2]["drawn_u_px"][0].get<double>(), 0.0);
  EXPECT_GT(fs::file_size(path("mode.mp4")), 1000U);
}

// The clip pans to the right, 2 px a frame: the roof is drawn where it has gone, by the same cycle.
TEST_F(Magnify, AllFramesAreWarpedWhereTheirRegionsAre) {
  constexpr int kPanned = 20;
  write_panned_clip(kPanned);
  write_tracks(kPanned);
  const Outcome outcome = magnified("--factor 0.4 --all-frames --plain --period-s 0.8 --crf 0 --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  const std::size_t at = outcome.text.find('{');
  ASSERT_NE(at, std::string::npos) << outcome.text;
  const auto told = nlohmann::json::parse(outcome.text.substr(at));
  EXPECT_EQ(told["frames"], kPanned);
  EXPECT_EQ(told["all_frames"], true);
  const double swing_px = told["regions"][0]["drawn_u_px"][0].get<double>();
  ASSERT_GT(swing_px, 0.5);
  const std::vector<double> shown = shifts_of_the_roof(path("mode.mp4"));
  ASSERT_EQ(shown.size(), static_cast<std::size_t>(kPanned));
  for (int k = 0; k < kPanned; ++k) {
    const double phase = 2.0 * std::numbers::pi * k / (0.8 * kRate_hz);
    const double first_px = swing_px;  // frame 0 is drawn at the crest
    EXPECT_NEAR(shown[static_cast<std::size_t>(k)], 2.0 * k + swing_px * std::cos(phase) - first_px, 0.15) << k;
  }
}

// Images state no rate: it is the run's.
TEST_F(Magnify, AFolderOfImagesHasTheRateOfTheRun) {
  make_base_uncertain();
  fs::create_directories(path("frames"));
  cv::Mat frame(kHeight, kWidth, CV_8UC1);
  cv::randu(frame, 0, 255);
  for (int k = 0; k < 3; ++k) cv::imwrite(path(cv::format("frames/f%d.png", k)), frame);
  const Outcome outcome = magnified("--clip " + path("frames") + " --factor 0.4 --seconds 1 --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_GT(fs::file_size(path("mode.mp4")), 1000U);
}

TEST_F(Magnify, StatesWhatItHoldsStillAndDoesNotOverwrite) {
  make_base_uncertain();
  Outcome outcome = magnified("--seconds 1");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("mode 1: 1.99"));
  EXPECT_THAT(outcome.text, HasSubstr("held still: this would magnify noise"));
  EXPECT_THAT(outcome.text, Not(HasSubstr("wall")));
  outcome = magnified("--seconds 1");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.text, HasSubstr("mode.mp4: exists; name another file, or --force"));
  outcome = magnified("--seconds 1 --force --quiet");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.text, "");
}

TEST_F(Magnify, RefusesToMagnifyNoise) {
  edit([](nlohmann::ordered_json& mode) {
    for (auto& sigma : mode["shape_std"]) sigma = 0.6;
  });
  Outcome outcome = magnified("");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.text, HasSubstr("this would magnify noise"));
  edit([](nlohmann::ordered_json& mode) { mode["shape_std"] = nullptr; });
  outcome = magnified("");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.text, HasSubstr("nobody knows whether this would magnify noise"));
  EXPECT_FALSE(fs::exists(path("mode.mp4")));
}

TEST_F(Magnify, RefusesWhatItCannotDraw) {
  Outcome outcome = magnified("--mode 2");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.text, HasSubstr("--mode 2: "));
  outcome = magnified("--factor 1000");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.text, HasSubstr("parts of the image would be pushed over each other; at most"));
  fs::remove(path("clip.mp4"));
  outcome = magnified("");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.text, HasSubstr("--clip is needed"));
}

}  // namespace
