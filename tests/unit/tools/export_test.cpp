#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "firmware_app/report/modal_json.h"
#include "tests/support/command.h"

// `hovermodal export` and `hovermodal identify` as a user runs them.
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using tests::Outcome;

// A run's folder: displacements.csv of two floors at 25 Hz with one mode of 2 Hz, and the modal.json of its
// identification.
class Export : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / "hovermodal_export" /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::ofstream table(folder_ / "displacements.csv");
    table << "# unit: mm\n# rate_hz: 25\n# row_delay_s.roof: 0.002\n# row_delay_s.middle: 0.011\n"
             "frame,t_s,scale_mm_per_px,roof,middle\n";
    std::mt19937_64 random(7);
    std::normal_distribution<double> gaussian;
    constexpr double kPerFrame = 2.0 * 3.14159265358979 * 2.0 / 25.0;
    const double r = std::exp(-0.01 * kPerFrame);
    double y = 0.0, before = 0.0;
    for (int k = 0; k < 3000; ++k) {
      const double next = 2.0 * r * std::cos(kPerFrame) * y - r * r * before + gaussian(random);
      before = y, y = next;
      table << k << ',' << k / 25.0 << ",2," << y + 0.05 * gaussian(random) << ','
            << (k == 100 ? std::string() : std::to_string(0.5 * y + 0.05 * gaussian(random))) << '\n';
    }
    table.close();
    std::ofstream(folder_ / "tracks.csv") << "# image_size_px: 100 x 100\nframe,t_s,point,region,u_px,v_px,sigma_px\n"
                                             "0,0,0,roof,10,20,0.1\n0,0,1,roof,14,20,0.1\n0,0,2,middle,12,60,0.1\n"
                                             "1,0.04,0,roof,99,99,0.1\n";
    const Outcome outcome = identify("displacements.csv", "made");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
    fs::copy_file(folder_ / "made" / "modal.json", folder_ / "modal.json");
  }

  Outcome identify(const std::string& series, const std::string& report) {
    return tests::run("hovermodal",
                      "identify --series " + (folder_ / series).string() + " --report " + (folder_ / report).string());
  }
  Outcome exported(const std::string& format, const std::string& more = "") {
    return tests::run("hovermodal", "export " + folder_.string() + " --to " + format + " --out " +
                                        (folder_ / ("run." + format)).string() + more);
  }
  app::ModalReport modes_of(const std::string& report) {
    return app::read_modal_json((folder_ / report / "modal.json").string());
  }

  fs::path folder_;
};

TEST_F(Export, ModesOfTheExportedSeriesAreThoseOfTheRun) {
  const core::Mode expected = modes_of("made").estimate.modes.at(0);
  for (const std::string format : {"mat", "uff"}) {
    ASSERT_EQ(exported(format).exit_code, 0);
    const Outcome outcome = identify("run." + format, format);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
    const app::ModalReport report = modes_of(format);
    EXPECT_THAT(report.channel_names, testing::ElementsAre("roof", "middle"));
    EXPECT_NEAR(report.estimate.modes.at(0).frequency_hz, expected.frequency_hz, 1e-9) << format;
    EXPECT_NEAR(report.estimate.modes.at(0).damping_ratio, expected.damping_ratio, 1e-9) << format;
  }
}

TEST_F(Export, PlacesAreTheMiddlesOfTheRegionsPointsInMillimetres) {
  ASSERT_EQ(exported("uff").exit_code, 0);
  const std::string text = tests::read(folder_ / "run.uff");
  EXPECT_THAT(text, HasSubstr("         1         0         0        11  2.40000E+01 -4.00000E+01  0.00000E+00\n"));
  EXPECT_THAT(text, HasSubstr("         2         0         0        11  2.40000E+01 -1.20000E+02  0.00000E+00\n"));
}

TEST_F(Export, WhatIsNotThereIsLeftOutWithANote) {
  fs::remove(folder_ / "displacements.csv");
  fs::remove(folder_ / "tracks.csv");
  const Outcome outcome = exported("mcap");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.text, HasSubstr("no displacements.csv beside modal.json: modes only"));
  EXPECT_THAT(outcome.text, HasSubstr("no tracks.csv beside modal.json"));
  EXPECT_THAT(tests::read(folder_ / "run.mcap"), Not(HasSubstr("/displacement")));
}

TEST_F(Export, AnExistingFileIsReplacedOnlyOnRequest) {
  ASSERT_EQ(exported("csv").exit_code, 0);
  const Outcome again = exported("csv");
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.text, HasSubstr("--force"));
  EXPECT_EQ(exported("csv", " --force").exit_code, 0);
}

TEST_F(Export, FaultsNameTheFileAndTheRemedy) {
  const Outcome no_run = tests::run("hovermodal", "export " + (folder_ / "made" / "none").string() +
                                                      " --to csv --out " + (folder_ / "x.csv").string());
  EXPECT_EQ(no_run.exit_code, 2);
  EXPECT_THAT(no_run.text, HasSubstr("name the folder that --report"));
  std::ofstream(folder_ / "modal.json") << "{";
  const Outcome broken = exported("csv");
  EXPECT_EQ(broken.exit_code, 1);
  EXPECT_THAT(broken.text, HasSubstr("modal.json"));
  std::ofstream(folder_ / "v73.mat") << "MATLAB 7.3 MAT-file" << std::string(512, ' ');
  const Outcome newer = identify("v73.mat", "x");
  EXPECT_EQ(newer.exit_code, 1);
  EXPECT_THAT(newer.text, HasSubstr("-v7"));
}

}  // namespace
