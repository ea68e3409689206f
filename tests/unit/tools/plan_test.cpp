#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "firmware_app/config/config.h"
#include "tests/support/command.h"
#include "tests/support/xml_fault.h"

// `hovermodal plan` as a user runs it.
namespace {

namespace fs = std::filesystem;

using tests::Outcome;
using tests::read;

Outcome plan(const std::string& arguments) { return tests::run("hovermodal", "plan " + arguments); }

const std::string kFrame =
    "--storeys 6 --storey-mm 140 --frequencies 1.657,5.04,8.14,10.83,12.93,14.34 --damping-percent 1 ";
const std::string kCamera = "--distance-m 2 --focal-px 2100 --fps 25 --readout-ms 26 --exposure-ms 4 ";
const std::string kAmplitudes = "--amplitude-mm 4,0.22,0.054,0.018,0.006,0.002 ";

class Plan : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / "hovermodal_plan" /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
};

TEST_F(Plan, TellsWhereThePapersModesAppearAndWhatToDo) {
  const Outcome outcome = plan(kFrame + kCamera + kAmplitudes + "--battery-min 20");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  for (const char* expected : {"12.071", "10.661", "resolved", "0.9524 mm/px", "fly with 29.97 fps", "modes 4 and 6",
                               "One battery of 20 min is enough", "mode 6 stands less than 10"}) {
    EXPECT_NE(outcome.text.find(expected), std::string::npos) << expected << "\n" << outcome.text;
  }
}

TEST_F(Plan, FragmentIsTakenByTheServicesConfiguration) {
  const Outcome outcome = plan(kFrame +
                               "--distance-m 2 --focal-px 2100 --fps 29.97 --readout-ms -18.5 --readout-direction up "
                               "--exposure-ms 2.5 --points 40 --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  const auto json = nlohmann::json::parse(outcome.text);
  std::string yaml = json.at("configuration").get<std::string>();
  yaml += "regions:\n  - {name: roof, rect: [794, 94, 288, 28]}\n";
  const app::AppConfig config = app::parse_config(yaml, "fragment", {"camera.source=flight.mp4"});
  EXPECT_DOUBLE_EQ(config.camera.rate_hz, 29.97);
  EXPECT_DOUBLE_EQ(config.camera.readout_ms, -18.5);
  EXPECT_EQ(config.camera.readout_direction, core::ReadoutDirection::kUp);
  EXPECT_DOUBLE_EQ(config.camera.exposure_ms, 2.5);
  EXPECT_EQ(config.tracking.points_per_region, 40);
  EXPECT_EQ(config.spectrum.segment, json.at("hover").at("segment").get<int>());
  EXPECT_DOUBLE_EQ(config.identification.max_frequency_hz, 16.0);
}

TEST_F(Plan, WritesPlanJsonAndPicture) {
  const std::string out = (folder_ / "out").string();
  const Outcome outcome = plan(kFrame + kCamera + "--out " + out);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  const auto json = nlohmann::json::parse(read(folder_ / "out" / "plan.json"));
  ASSERT_EQ(json.at("modes").size(), 6U);
  const auto& fifth = json.at("modes")[4];
  EXPECT_NEAR(fifth.at("apparent_hz").get<double>(), 12.07, 2e-3);
  EXPECT_EQ(fifth.at("fold_n").get<int>(), -1);
  EXPECT_EQ(fifth.at("fold").get<std::string>(), "resolved");
  EXPECT_TRUE(fifth.at("expected_rms_mm").is_null());
  EXPECT_TRUE(json.at("modes")[0].at("fold_margin").is_null());
  EXPECT_EQ(json.at("modes")[3].at("overlaps_modes"), nlohmann::json::array({6}));
  const std::string svg = read(folder_ / "out" / "plan.svg");
  EXPECT_EQ(test_support::xml_fault(svg), "");
  for (const char* label : {"4: 10.83", "6: 14.34*", "5: 12.93*"})
    EXPECT_NE(svg.find(label), std::string::npos) << label;
}

TEST_F(Plan, TheEarlierPlanOfAFolderStaysBesideTheNewOne) {
  const std::string out = " --out " + (folder_ / "out").string();
  ASSERT_EQ(plan(kFrame + kCamera + out).exit_code, 0);
  const std::string first = read(folder_ / "out" / "plan.json");
  ASSERT_EQ(plan(kFrame + kCamera + kAmplitudes + out).exit_code, 0);
  EXPECT_NE(read(folder_ / "out" / "plan.json"), first);
  EXPECT_EQ(read(folder_ / "out" / "plan.1" / "plan.json"), first);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "plan.1" / "plan.svg"));
}

TEST_F(Plan, SameInputGivesTheSameBytes) {
  for (const char* name : {"a", "b"})
    ASSERT_EQ(plan(kFrame + kCamera + kAmplitudes + "--out " + (folder_ / name).string()).exit_code, 0);
  for (const char* file : {"plan.json", "plan.svg"})
    EXPECT_EQ(read(folder_ / "a" / file), read(folder_ / "b" / file)) << file;
}

TEST_F(Plan, FocalLengthInEveryWayGivesTheSameScale) {
  const std::string rest = kFrame + "--distance-m 2 --json ";
  const auto scale = [&](const std::string& focal) {
    const Outcome outcome = plan(rest + focal);
    return outcome.exit_code == 0 ? nlohmann::json::parse(outcome.text).at("view").at("mm_per_px").get<double>() : 0.0;
  };
  EXPECT_NEAR(scale("--focal-px 2100"), 0.952381, 1e-6);
  EXPECT_NEAR(scale("--focal-mm 10.5 --sensor-width-mm 9.6"), 0.952381, 1e-6);  // 10.5 / 9.6 * 1920 = 2100
  EXPECT_NEAR(scale("--fov-deg 49.13434"), 0.952381, 1e-5);                     // 2 atan(960 / 2100)
}

TEST_F(Plan, WarnsOfWhatAFlightCouldNotMend) {
  const Outcome tower = plan(
      "--structure cantilever --size-m 90 --frequencies 0.21,0.9,2.6,12 --distance-m 150 --fov-deg 70 --fps 25 "
      "--readout-ms 18 --exposure-ms 40 --battery-min 15");
  ASSERT_EQ(tower.exit_code, 0) << tower.text;
  EXPECT_NE(tower.text.find("Below 0.5 Hz, where mode 1 is seen"), std::string::npos) << tower.text;
  EXPECT_NE(tower.text.find("less than 0.7 of mode 4"), std::string::npos) << tower.text;
  EXPECT_NE(tower.text.find("flights"), std::string::npos) << tower.text;
  const Outcome close = plan(kFrame + "--distance-m 1.7 --focal-px 2100");
  EXPECT_NE(close.text.find("does not fit"), std::string::npos) << close.text;
  EXPECT_NE(close.text.find("or rotate the camera"), std::string::npos) << close.text;
}

TEST_F(Plan, TurnsTheCameraForABridge) {
  const Outcome outcome = plan(
      "--structure beam --size-m 40 --frequencies 2.1,8.3,18.5 --distance-m 150 --focal-mm 24 --sensor-width-mm 13.2 "
      "--image 2160p --fps 29.97 --rates 24,25,29.97 --readout-ms 20 --exposure-ms 2");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("rotate the camera by 90 degrees"), std::string::npos) << outcome.text;
}

TEST_F(Plan, ReadsGivenShapes) {
  std::ofstream(folder_ / "shapes.csv") << "position_mm,first,second\n200,0.2,0.9\n500,0.6,0.4\n1000,1,-1\n";
  const std::string rest = " --size-m 1 --frequencies 3,13 --distance-m 2 --focal-px 1800 --fps 20 --readout-ms 30 ";
  const Outcome outcome = plan("--json" + rest + "--shapes " + (folder_ / "shapes.csv").string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  EXPECT_EQ(nlohmann::json::parse(outcome.text).at("modes")[1].at("fold").get<std::string>(), "resolved");
  std::ofstream(folder_ / "no_place.csv") << "first,second\n0.2,0.9\n";
  EXPECT_NE(plan("--shapes " + (folder_ / "no_place.csv").string() + rest).text.find("position_mm"), std::string::npos);
  std::ofstream(folder_ / "one.csv") << "position_mm,first\n200,0.2\n";
  EXPECT_EQ(plan("--shapes " + (folder_ / "one.csv").string() + rest).exit_code, 2);
}

TEST_F(Plan, RefusesBadUsageWithExitCode2) {
  const std::string f = "--frequencies 1.657,5.04 ", s = "--storeys 6 --storey-mm 140 ",
                    c = "--distance-m 2 --focal-px 2100 ";
  const std::pair<std::string, const char*> cases[] = {{s + c, "frequencies"},
                                                       {f + s + "--focal-px 2100", "distance"},
                                                       {f + s + "--distance-m 2", "no focal length"},
                                                       {f + s + c + "--fov-deg 60", "in one way only"},
                                                       {f + s + "--distance-m 2 --focal-mm 24", "--sensor-width-mm"},
                                                       {f + s + c + "--fps 0", "frame rate"},
                                                       {f + s + c + "--fps nan", "--fps: nan is no finite number"},
                                                       {f + s + c + "--fps -25", "frame rate"},
                                                       {f + s + c + "--readout-ms 41", "readout"},
                                                       {f + s + c + "--readout-ms nan", "no finite number"},
                                                       {f + s + c + "--exposure-ms -1", "exposure"},
                                                       {f + s + c + "--image 10x", "--image"},
                                                       {f + s + c + "--image nanxnan", "--image"},
                                                       {f + s + c + "--region-mm big", "--region-mm"},
                                                       {f + s + c + "--points 0", "points"},
                                                       {f + s + c + "--damping-percent 1,2,3", "one for each"},
                                                       {f + s + c + "--damping-percent 0", "damping"},
                                                       {f + s + c + "--amplitude-mm -1", "amplitude"},
                                                       {f + s + c + "--hover-min 0", "--hover-min"},
                                                       {f + s + c + "--battery-min nan", "--battery-min"},
                                                       {f + s + c + "--size-m 1", "size once"},
                                                       {f + s + c + "--structure beam", "--size-m"},
                                                       {f + s + c + "--structure dome", "structure"},
                                                       {f + s + c + "--regions 5", "--regions"},
                                                       {f + s + c + "--shapes /nowhere.csv", "nowhere.csv"},
                                                       {f + "--storeys 0 --storey-mm 140 " + c, "--storeys"},
                                                       {f + "--storeys 6 --storey-mm nan " + c, "--storey-mm"},
                                                       {f + s + "--distance-m nan --focal-px 2100", "--distance-m"},
                                                       {"--frequencies 1,nan " + s + c, "nan"},
                                                       {"--frequencies 5,1 " + s + c, "ascending"},
                                                       {"--frequencies 1,2,3,4,5,6,7 " + s + c, "each floor"},
                                                       {"--frequencies '' " + s + c, ""}};
  for (const auto& [arguments, hint] : cases) {
    const Outcome outcome = plan(arguments);
    EXPECT_TRUE(outcome.exit_code == 2 || (outcome.exit_code == 1 && arguments.find("nowhere") != std::string::npos))
        << arguments << ": " << outcome.exit_code << ' ' << outcome.text;
    EXPECT_NE(outcome.text.find(hint), std::string::npos) << arguments << ": " << outcome.text;
  }
}

TEST_F(Plan, RefusesMoreThan40ModesAndAFolderThatIsAFile) {
  std::string many = "1";
  for (int i = 2; i <= 41; ++i) many += "," + std::to_string(i);
  const Outcome outcome =
      plan("--structure beam --size-m 1 --distance-m 3 --focal-px 1000 --fps 200 --frequencies " + many);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.text.find("41"), std::string::npos) << outcome.text;
  std::ofstream(folder_ / "file") << "x";
  EXPECT_EQ(plan(kFrame + kCamera + "--out " + (folder_ / "file").string()).exit_code, 2);
}

TEST_F(Plan, HelpShowsAWorkedExampleThatRuns) {
  const std::string help = plan("--help").text;
  EXPECT_NE(help.find("Yoon"), std::string::npos);
  std::istringstream lines(help);
  std::string line, command;
  int n_run = 0;
  while (std::getline(lines, line)) {
    if (line.starts_with("  hovermodal plan ")) {
      command = line.substr(18);
    } else if (!command.empty()) {
      command += line;
    }
    if (command.empty()) continue;
    if (command.ends_with("\\")) {
      command.pop_back();
      continue;
    }
    const std::size_t out = command.find("--out plan");
    if (out != std::string::npos) command.erase(out, 10);
    const Outcome outcome = plan(command);
    EXPECT_EQ(outcome.exit_code, 0) << command << ": " << outcome.text;
    command.clear();
    ++n_run;
  }
  EXPECT_EQ(n_run, 2);
}

}  // namespace
