#include "firmware_app/report/pictures.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <random>

#include "drivers/storage/text_file.h"
#include "tests/support/xml_fault.h"

namespace app {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMaxFileBytes = 500'000;

// A run's data, made up: channels on a vertical line, three modes of which the last is folded.
struct RunData {
  core::Frame frame;
  core::TrackFrame keyframe;
  core::CpsdSums spectrum;
  core::ModalEstimate estimate;
  PictureInputs inputs;
};

void add_channel(RunData& run, std::size_t i, std::size_t n) {
  core::Region region;
  region.name = fmt::format("floor{}", i);
  const double step = 1000.0 / static_cast<double>(n);
  region.u_px = 800.0, region.v_px = 40.0 + step * static_cast<double>(n - 1 - i);
  region.width_px = 300.0, region.height_px = std::min(40.0, step);
  if (i == 0) region.role = core::RegionRole::kBase;
  run.inputs.regions.push_back(region);
  core::ChannelInfo channel;
  channel.name = region.name, channel.region = static_cast<std::uint16_t>(i), channel.is_base = i == 0;
  run.inputs.channels.push_back(channel);
  for (std::uint32_t k = 0; k < 20; ++k) {
    run.keyframe.points.push_back({805.0 + 15.0 * k, region.v_px + std::fmod(7.3 * k, region.height_px), 0.05, k,
                                   static_cast<std::uint16_t>(i), k % 7 != 6, true});
  }
}

// Noise: the worst to compress.
void fill_frame(RunData& run, int width_px, int height_px) {
  run.frame.width_px = width_px, run.frame.height_px = height_px;
  run.frame.pixels.resize(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
  std::mt19937 random(1);
  for (std::uint8_t& pixel : run.frame.pixels) pixel = static_cast<std::uint8_t>(random() % 256);
}

void fill_spectrum(RunData& run, std::size_t n) {
  core::CpsdSums& sums = run.spectrum;
  sums.n_channels = static_cast<int>(n), sums.n_fft = 4096, sums.rate_hz = 25.0, sums.n_segments = 8,
  sums.window_power = 768.0;
  sums.data_sum.assign(static_cast<std::size_t>(sums.n_bins()) * static_cast<std::size_t>(sums.n_pairs()), 0.0);
  std::mt19937 random(1);
  for (int k = 0; k < sums.n_bins(); ++k) {
    for (int c = 0; c < sums.n_channels; ++c) {
      double value = 1.0 + static_cast<double>(random() % 1000) / 1000.0;
      for (const double f0 : {1.657, 5.04, 12.07}) {
        value += 100.0 * (c + 1) / (0.01 + std::pow(k * sums.rate_hz / sums.n_fft - f0, 2.0));
      }
      const auto at = static_cast<std::size_t>(k * sums.n_pairs() + core::CpsdSums::pair_index(c, c, sums.n_channels));
      sums.data_sum[at] = value;
    }
  }
}

core::Mode mode(double frequency_hz, double apparent_hz, std::size_t n_channels, core::Verdict verdict) {
  core::Mode out;
  out.frequency_hz = frequency_hz, out.apparent_hz = apparent_hz, out.damping_ratio = 0.0102, out.mpc = 0.998;
  out.frequency_std_hz = 0.003, out.damping_std = 0.001;
  out.fold_n = frequency_hz > 12.5 ? 1 : 0;
  for (std::size_t i = 0; i < n_channels; ++i) {
    const double along = n_channels > 1 ? static_cast<double>(i) / static_cast<double>(n_channels - 1) : 1.0;
    out.shape.emplace_back(std::sin(along * std::numbers::pi * (0.5 + frequency_hz / 4.0)), 0.01);
    out.shape_std.push_back(0.05);
  }
  out.verdict = verdict;
  return out;
}

class PicturesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) / "pictures_test" /
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }

  void make(RunData& run, std::size_t n_channels, std::size_t n_samples) {
    for (std::size_t i = 0; i < n_channels; ++i) add_channel(run, i, n_channels);
    fill_frame(run, 640, 360);
    fill_spectrum(run, n_channels);
    run.estimate.status = "ok";
    for (const auto& [true_hz, apparent_hz] : {std::pair{1.657, 1.657}, {5.04, 5.04}, {12.93, 12.07}}) {
      run.estimate.modes.push_back(mode(true_hz, apparent_hz, n_channels, core::Verdict::kStructural));
    }
    run.estimate.rejected.push_back(mode(0.3, 0.3, n_channels, core::Verdict::kCameraMotion));
    run.estimate.rejected.push_back(mode(7.0, 7.0, n_channels, core::Verdict::kInputPeak));
    run.inputs.first_frame = &run.frame, run.inputs.keyframe = &run.keyframe;
    run.inputs.spectrum = &run.spectrum, run.inputs.estimate = &run.estimate;
    run.inputs.millimetres = true;
    run.inputs.displacements_csv = csv(run.inputs.channels, n_samples);
  }

  // Every 10th sample of a channel is missing, 20 frames in a row, and the whole of the last channel of three or more.
  [[nodiscard]] std::string csv(const std::vector<core::ChannelInfo>& channels, std::size_t n_samples) const {
    const std::string path = (folder_ / "displacements.csv").string();
    std::ofstream out(path);
    out << "# unit: mm\nframe,t_s,scale_mm_per_px";
    for (const core::ChannelInfo& channel : channels) out << ',' << channel.name;
    for (std::size_t k = 0; k < n_samples; ++k) {
      if (k >= 100 && k < 120) continue;
      const double t = static_cast<double>(k) / 25.0;
      out << fmt::format("\n{},{:.4f},{:.6f}", k, 1000.0 + t, 0.95 + 0.02 * std::sin(0.7 * t));
      for (std::size_t c = 0; c < channels.size(); ++c) {
        const bool missing = (k + c) % 10 == 9 || (c >= 2 && c + 1 == channels.size());
        const double value = 20.0 * std::sin(0.3 * t) + static_cast<double>(c + 1) * std::sin(10.4 * t);
        out << ',' << (missing ? "" : fmt::format("{:.6f}", value));
      }
    }
    out << '\n';
    return path;
  }

  [[nodiscard]] std::vector<std::string> write(const RunData& run, const std::string& name = "out") const {
    fs::create_directories(folder_ / name);
    return write_pictures((folder_ / name).string(), run.inputs);
  }
  [[nodiscard]] std::string text_of(const std::string& picture, const std::string& name = "out") const {
    return drivers::read_text_file((folder_ / name / picture).string(), 1U << 24U);
  }
  void expect_sound(const std::vector<std::string>& names, const std::string& folder = "out") const {
    for (const std::string& name : names) {
      const std::string text = text_of(name, folder);
      EXPECT_LT(text.size(), kMaxFileBytes) << name;
      if (!name.ends_with(".svg")) continue;
      EXPECT_EQ(test_support::xml_fault(text), "") << name;
      for (const char* bad : {"nan", "NaN", "inf\"", "inf ", "-inf", "<script", "href"})
        EXPECT_THAT(text, Not(HasSubstr(bad))) << name;
    }
  }

  fs::path folder_;
};

TEST_F(PicturesTest, WritesEveryPictureOfACompleteRun) {
  RunData run;
  make(run, 7, 1500);
  fill_frame(run, 1920, 1080);
  const std::vector<std::string> names = write(run);
  EXPECT_THAT(names, ElementsAre("frame.png", "displacements.svg", "scale.svg", "spectra.svg", "modes.svg"));
  expect_sound(names);
  EXPECT_THAT(text_of("frame.png"), ::testing::StartsWith("\x89PNG"));
  EXPECT_THAT(text_of("spectra.svg"), HasSubstr("12.93 Hz, seen at 12.07"));
  EXPECT_THAT(text_of("spectra.svg"), HasSubstr("camera motion"));
  EXPECT_THAT(text_of("modes.svg"), HasSubstr("1.657 ± 0.003 Hz"));
  EXPECT_THAT(text_of("displacements.svg"), HasSubstr("no sample"));
  EXPECT_THAT(text_of("scale.svg"), HasSubstr("scale, mm/px"));
}

TEST_F(PicturesTest, GivesTheSameBytesForTheSameInput) {
  RunData run;
  make(run, 3, 500);
  const std::vector<std::string> names = write(run, "first");
  EXPECT_EQ(names, write(run, "second"));
  for (const std::string& name : names) EXPECT_EQ(text_of(name, "first"), text_of(name, "second")) << name;
}

TEST_F(PicturesTest, OneChannelWithoutModesSaysNoModes) {
  RunData run;
  make(run, 1, 300);
  run.estimate.modes.clear();
  run.estimate.status = "too few <segments>";
  const std::vector<std::string> names = write(run);
  expect_sound(names);
  EXPECT_THAT(text_of("modes.svg"), HasSubstr("no modes"));
  EXPECT_THAT(text_of("modes.svg"), HasSubstr("too few &lt;segments&gt;"));
}

TEST_F(PicturesTest, StaysSmallWith64ChannelsAndALongRecord) {
  RunData run;
  make(run, 64, 10'000);
  for (int i = 0; i < 40; ++i) {
    run.estimate.modes.push_back(mode(6.0 + 0.1 * i, 6.0 + 0.1 * i, 64, core::Verdict::kStructural));
  }
  const std::vector<std::string> names = write(run);
  EXPECT_EQ(names.size(), 5U);
  expect_sound(names);
  EXPECT_THAT(text_of("modes.svg"), HasSubstr("more"));
}

TEST_F(PicturesTest, LeavesOutWhatHasNoInputAndRemovesAnOlderPicture) {
  fs::create_directories(folder_ / "out");
  std::ofstream(folder_ / "out" / "spectra.svg") << "of an earlier run";
  EXPECT_THAT(write(RunData{}), IsEmpty());
  EXPECT_TRUE(fs::is_empty(folder_ / "out"));
}

TEST_F(PicturesTest, LeavesOutAScaleThatDoesNotVary) {
  RunData run;
  run.inputs.displacements_csv = (folder_ / "flat.csv").string();
  std::ofstream(run.inputs.displacements_csv) << "frame,t_s,scale_mm_per_px,a\n0,0,0.5,1\n1,0.04,0.5,1\n";
  const std::vector<std::string> names = write(run);
  EXPECT_THAT(names, ElementsAre("displacements.svg"));
  expect_sound(names);
}

TEST_F(PicturesTest, SurvivesValuesThatAreNotFiniteAndListsThatDoNotMatch) {
  RunData run;
  make(run, 4, 50);
  run.spectrum.data_sum[40] = kNan;
  for (std::size_t i = 0; i < run.spectrum.data_sum.size(); i += 10)
    run.spectrum.data_sum[i] = 0.0;  // channel 0 at rest
  run.estimate.modes[0].frequency_hz = kNan, run.estimate.modes[0].shape[1] = kNan,
  run.estimate.modes[0].shape_std[2] = kNan;
  run.estimate.modes[1].shape.resize(2), run.estimate.modes[1].apparent_hz = kNan, run.estimate.modes[1].mpc = kNan;
  run.estimate.modes[2].damping_std = kNan, run.estimate.modes[2].shape_std.assign(9, 1e300);
  run.keyframe.points[0].u_px = kNan, run.keyframe.points[1].v_px = 1e12;
  run.inputs.channels[3].region = 77;
  const std::vector<std::string> names = write(run);
  EXPECT_EQ(names.size(), 5U);
  expect_sound(names);
  run.spectrum.data_sum.resize(3), run.frame.pixels.resize(5);
  EXPECT_THAT(write(run), Not(::testing::AnyOf(Contains("spectra.svg"), Contains("frame.png"))));
}

TEST_F(PicturesTest, DrawsRegionsBesideEachOtherAndBothAxes) {
  RunData run;
  make(run, 6, 50);
  for (std::size_t i = 0; i < 6; ++i) {
    core::Region& region = run.inputs.regions[i];
    region.u_px = 40.0 + 310.0 * static_cast<double>(i / 2), region.v_px = 500.0, region.both_axes = true;
    run.inputs.channels[i].region = static_cast<std::uint16_t>(i / 2 * 2);
    run.inputs.channels[i].direction_u = i % 2 == 0 ? 1.0 : 0.0,
    run.inputs.channels[i].direction_v = i % 2 == 0 ? 0.0 : 1.0;
  }
  const std::vector<std::string> names = write(run);
  expect_sound(names);
  EXPECT_THAT(text_of("modes.svg"), HasSubstr("dashed: along v"));
}

TEST_F(PicturesTest, EscapesNames) {
  RunData run;
  make(run, 2, 50);
  run.inputs.channels[0].name = "a<b>&\"c'\x01\xFF";
  run.inputs.regions[0].name = "étage <1> & more";
  const std::vector<std::string> names = write(run);
  expect_sound(names);
  EXPECT_THAT(text_of("spectra.svg"), HasSubstr("a&lt;b&gt;&amp;&quot;c&#39;??"));
}

TEST_F(PicturesTest, AFailureIsAFileErrorAndTheOtherPicturesAreComplete) {
  RunData run;
  make(run, 2, 50);
  run.inputs.displacements_csv = (folder_ / "none.csv").string();
  try {
    (void)write(run);
    FAIL() << "a missing file was not told";
  } catch (const drivers::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("none.csv"));
  }
  expect_sound({"frame.png", "spectra.svg", "modes.svg"});
  EXPECT_THROW((void)write_pictures((folder_ / "no such folder").string(), run.inputs), drivers::FileError);
}

}  // namespace
}  // namespace app
