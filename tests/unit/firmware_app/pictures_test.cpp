#include "firmware_app/report/pictures/pictures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "drivers/storage/text_file.h"
#include "tests/support/made_up_run.h"
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

class PicturesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) / "pictures_test" /
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
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
  make_run(run, 7, 1500);
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
  make_run(run, 3, 500);
  const std::vector<std::string> names = write(run, "first");
  EXPECT_EQ(names, write(run, "second"));
  for (const std::string& name : names) EXPECT_EQ(text_of(name, "first"), text_of(name, "second")) << name;
}

TEST_F(PicturesTest, OneChannelWithoutModesSaysNoModes) {
  RunData run;
  make_run(run, 1, 300);
  run.estimate.modes.clear();
  run.estimate.status = "too few <segments>";
  const std::vector<std::string> names = write(run);
  expect_sound(names);
  EXPECT_THAT(text_of("modes.svg"), HasSubstr("no modes"));
  EXPECT_THAT(text_of("modes.svg"), HasSubstr("too few &lt;segments&gt;"));
}

TEST_F(PicturesTest, StaysSmallWith64ChannelsAndALongRecord) {
  RunData run;
  make_run(run, 64, 10'000);
  for (int i = 0; i < 40; ++i) {
    run.estimate.modes.push_back(made_up_mode(6.0 + 0.1 * i, 6.0 + 0.1 * i, 64, core::Verdict::kStructural));
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
  RunHistory history(25.0, 1, 0);
  for (std::int64_t k = 0; k < 2; ++k)
    history.add(core::DisplacementSample{0, k * 40'000'000, false, 0.5, {1.0}, {}, {1}, {}});
  run.inputs.history = &history;
  const std::vector<std::string> names = write(run);
  EXPECT_THAT(names, ElementsAre("displacements.svg"));
  expect_sound(names);
}

TEST_F(PicturesTest, SurvivesValuesThatAreNotFiniteAndListsThatDoNotMatch) {
  RunData run;
  make_run(run, 4, 50);
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
  make_run(run, 6, 50);
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
  make_run(run, 2, 50);
  run.inputs.channels[0].name = "a<b>&\"c'\x01\xFF";
  run.inputs.regions[0].name = "étage <1> & more";
  const std::vector<std::string> names = write(run);
  expect_sound(names);
  EXPECT_THAT(text_of("spectra.svg"), HasSubstr("a&lt;b&gt;&amp;&quot;c&#39;??"));
}

TEST_F(PicturesTest, AFailureIsAFileErrorAndTheOtherPicturesAreComplete) {
  RunData run;
  make_run(run, 2, 50);
  fs::create_directories(folder_ / "out" / "scale.svg" / "in the way");
  try {
    (void)write(run);
    FAIL() << "a picture that could not be written was not reported";
  } catch (const drivers::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("scale.svg"));
  }
  expect_sound({"frame.png", "displacements.svg", "spectra.svg", "modes.svg"});
  EXPECT_THROW((void)write_pictures((folder_ / "no such folder").string(), run.inputs), drivers::FileError);
}

}  // namespace
}  // namespace app
