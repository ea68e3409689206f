#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "tests/support/answers.h"
#include "tests/support/folder_test.h"

// --json and --quiet of the commands as a user runs them (`calibrate`, `readout`, `batch`: in their own files).
namespace {

using testing::HasSubstr;

class Answers : public tests::FolderTest {
 protected:
  [[nodiscard]] std::string path(const char* name) const { return (folder_ / name).string(); }
  void write(const char* name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
};

TEST_F(Answers, PlanPrintsItsFile) {
  const auto told = tests::expect_answers(
      "plan --storeys 3 --storey-mm 140 --frequencies 1.6,5,8 --distance-m 2 --focal-px 2100 --fps 25 --out " +
      path("plan"));
  EXPECT_EQ(told, nlohmann::json::parse(tests::read(path("plan/plan.json"))));
}

TEST_F(Answers, SimulateNamesWhatItMade) {
  const std::string made =
      "simulate --preset paper --size 270p --duration 2 --force --out " + path("made") + " --threads 1";
  const auto told = tests::expect_answers(made);
  EXPECT_EQ(told["product"], path("made/clip.mp4"));
  EXPECT_EQ(told["frames"], 50);
  EXPECT_EQ(told["already_made"], false);
  EXPECT_EQ(told["bytes"], std::filesystem::file_size(path("made/clip.mp4")));
  const auto again = tests::expect_answers("simulate --preset paper --size 270p --duration 2 --out " + path("made"));
  EXPECT_EQ(again["already_made"], true);
  // The text's progress is on standard error, and --json leaves it there.
  EXPECT_THAT(tests::run_apart(made + " --json").err, HasSubstr("simulate"));
}

TEST_F(Answers, IdentifyAndExportOfSimulatedChannels) {
  for (const char* depth : {"tracks", "channels"}) {
    const auto told = tests::expect_answers(std::string("simulate --preset paper --points 4 --duration 60 --force --") +
                                            depth + "-only --out " + path("made"));
    EXPECT_EQ(told["frames"], 1500);
  }
  const auto modes = tests::expect_answers("identify --series " + path("made/displacements.csv") +
                                           " --base base --segment 256 --report " + path("run"));
  EXPECT_EQ(modes, nlohmann::json::parse(tests::read(path("run/modal.json"))));
  const auto told = tests::expect_answers("export " + path("run") + " --to csv --force --out " + path("modes.csv"));
  EXPECT_EQ(told["modes"], modes["modes"].size());
  EXPECT_EQ(told["out"], path("modes.csv"));
}

TEST_F(Answers, RegionsListsTheProposal) {
  ASSERT_EQ(
      tests::run("hovermodal", "simulate --preset paper --duration 3 --size 540p --out " + path("clip")).exit_code, 0);
  const auto told =
      tests::expect_answers("regions " + path("clip/clip.mp4") + " --force --out " + path("regions.yaml"));
  ASSERT_GE(told["regions"].size(), 3U);
  EXPECT_EQ(told["size"], nlohmann::json({960, 540}));
  EXPECT_EQ(told["regions"].back()["role"], "background");
  EXPECT_TRUE(told["regions"].back()["shared"].is_null());
  const std::string yaml = tests::read(path("regions.yaml"));
  for (const auto& region : told["regions"])
    EXPECT_THAT(yaml, HasSubstr("name: " + region["name"].get<std::string>() + ","));
}

constexpr const char* kModes =
    R"({"version": 1, "method": "hovermodal", "rate_hz": 25, "duration_s": 60, "samples": 1500,
"segments": 5, "channels": [{"name": "floor1"}, {"name": "floor2"}], "modes": [
{"frequency_hz": %1, "damping_ratio": 0.01, "shape": {"floor1": [0.618, 0], "floor2": [1, 0]}},
{"frequency_hz": 5.236, "damping_ratio": 0.01, "shape": {"floor1": [1, 0], "floor2": [-0.618, 0]}}]})";

std::string modes_with(const char* first_hz) {
  std::string text = kModes;
  return text.replace(text.find("%1"), 2, first_hz);
}

TEST_F(Answers, InspectListsWhatItFinds) {
  EXPECT_TRUE(tests::expect_answers("inspect cameras")["cameras"].is_array());
  // Whatever the network is like: the document tells it, and a fault is the exit code's as well.
  const std::string lcm = "inspect lcm --seconds 0";
  const int exit_code = tests::run_apart(lcm).exit_code;
  const auto told = tests::expect_answers(lcm, exit_code);
  if (exit_code == 0) {
    EXPECT_GT(told["findings"].size(), 2U);
    for (const auto& finding : told["findings"]) EXPECT_NE(finding["kind"], "bad") << finding;
  }
}

TEST_F(Answers, InspectCostDividesWhatARunTookByItsFrames) {
  ASSERT_EQ(
      tests::run("hovermodal", "simulate --preset paper --size 270p --duration 4 --out " + path("made")).exit_code, 0);
  const std::string cost = "inspect cost --config " + path("made/config.yaml") +
                           " --set spectrum.segment=64 --set report.directory=" + path("none");
  EXPECT_THAT(tests::run_apart(cost).out, HasSubstr("us a frame"));
  const auto told = nlohmann::json::parse(tests::run_apart(cost + " --json").out);
  EXPECT_EQ(told["frames"], 100);
  EXPECT_GT(told["points"].get<int>(), 20);
  double stages_us = 0.0;
  for (const auto& stage : told["stages"]) {
    if (stage["name"] != "all") stages_us += stage["cpu_us_per_frame"].get<double>();
  }
  EXPECT_EQ(told["stages"].back()["name"], "all");
  EXPECT_NEAR(stages_us, told["stages"].back()["cpu_us_per_frame"].get<double>(), 1e-3 * stages_us);
  EXPECT_GT(told["peak_mb"].get<double>(), 10.0);
  for (const char* unknown_somewhere : {"instructions_per_frame", "joules_per_frame"})
    EXPECT_TRUE(told[unknown_somewhere].is_null() || told[unknown_somewhere].get<double>() > 0.0) << unknown_somewhere;
  EXPECT_FALSE(std::filesystem::exists(path("none"))) << "nothing is written";
}

TEST_F(Answers, GroundDoesNotKeepAnAccessTokenToItself) {
  const tests::Streams quiet = tests::run_apart("ground --bind 0.0.0.0 --port 0 --seconds 0.1 --quiet");
  EXPECT_NE(quiet.exit_code, 0);
  EXPECT_EQ(quiet.out, "");
  EXPECT_THAT(quiet.err, testing::AnyOf(HasSubstr("give one by --token"), HasSubstr("this build has no web server")));
}

TEST_F(Answers, CompareListsTheModes) {
  write("a.json", modes_with("2.02"));
  write("b.json", modes_with("2"));
  const auto told = tests::expect_answers("compare --result " + path("a.json") + " --reference " + path("b.json"));
  ASSERT_EQ(told["modes"].size(), 2U);
  const auto& first = told["modes"][0];
  EXPECT_EQ(first["mode"], 1);
  EXPECT_NEAR(first["error_percent"].get<double>(), 1.0, 1e-9);
  EXPECT_NEAR(first["mac_percent"].get<double>(), 100.0, 1e-9);
  EXPECT_TRUE(first["true_hz"].is_null());
  const auto truth = tests::expect_answers("compare --result " + path("a.json") + " --reference " + path("b.json") +
                                           " --truth " + path("b.json") + " --paper");
  // sqrt(0.01 / (2 pi 2 60)) = 0.364 %
  EXPECT_NEAR(truth["modes"][0]["true_error_sigmas"].get<double>(), 1.0 / 0.3642, 0.01);
  EXPECT_EQ(truth["modes"][1]["paper"]["drone_hz"], 5.043);
}

TEST_F(Answers, CompareNamesAFileThatIsNoResult) {
  write("a.json", modes_with("2"));
  write("broken.json", "{\"modes\": [");
  write("other.json", "{\"modes\": 3}");
  for (const char* name : {"broken.json", "other.json"}) {
    const auto outcome =
        tests::run_apart("compare --result " + path(name) + " --reference " + path("a.json") + " --quiet");
    EXPECT_NE(outcome.exit_code, 0);
    EXPECT_THAT(outcome.err, HasSubstr(path(name) + ":"));
    EXPECT_THAT(outcome.err, testing::Not(HasSubstr("json.exception")));
    EXPECT_EQ(outcome.out, "");
  }
}

TEST_F(Answers, CloseloopPrintsItsFile) {
  write("frame.yaml", "structure: {kind: shear_frame, storeys: 2}\n");
  write("modes.json", modes_with("2"));
  const auto told = tests::expect_answers("closeloop --structure " + path("frame.yaml") + " --reference " +
                                          path("modes.json") + " --report " + path("loop"));
  EXPECT_EQ(told, nlohmann::json::parse(tests::read(path("loop/closure.json"))));
}

// Modes of a record too short to estimate their ±: as much as the duration allows, unless the structure declares it.
TEST_F(Answers, CloseloopTakesTheNoiseOfARecordFromItsLength) {
  write("modes.json", modes_with("2"));
  const auto noise_percent = [&](const std::string& declared) {
    write("frame.yaml", "structure: {kind: shear_frame, storeys: 2" + declared + "}\n");
    return tests::expect_answers("closeloop --structure " + path("frame.yaml") + " --reference " + path("modes.json"))
        .at("baseline")
        .at("noise_floor")
        .get<double>();
  };
  // 1.2 sqrt(0.01 / (2 pi f 60)): 0.437 % at 2 Hz, 0.270 % at 5.236 Hz; rms of both.
  EXPECT_NEAR(noise_percent(""), 0.3633, 0.001);
  EXPECT_NEAR(noise_percent(", frequency_sigma_percent: 0.2"), 0.2, 1e-6);
}

TEST_F(Answers, SimulateWritesAConfigurationThatTheServiceTakesAtEverySize) {
  for (const char* size : {"1080p", "720p", "270p"}) {
    const std::string made = path(size);
    const auto outcome =
        tests::run("hovermodal", std::string("simulate --preset paper --size ") + size + " --duration 1 --out " + made);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
    const auto check = tests::run("hovermodald", "--config " + made + "/config.yaml --check");
    EXPECT_EQ(check.exit_code, 0) << size << ": " << check.text;
  }
}

TEST_F(Answers, RegionsNamesItsOwnOptionForTheRate) {
  std::filesystem::create_directories(path("images"));
  std::ofstream(path("images/f1.pgm"), std::ios::binary) << "P5\n64 64\n255\n" << std::string(64 * 64, 'a');
  const auto outcome = tests::run_apart("regions " + path("images"));
  EXPECT_NE(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("--rate-hz"));
  EXPECT_THAT(outcome.err, testing::Not(HasSubstr("camera.rate_hz")));
}

TEST_F(Answers, RegionsReplacesAFileOnlyWithForce) {
  write("regions.yaml", "mine");
  write("regions.png", "mine");
  for (const char* option : {" --out ", " --picture "}) {
    const std::string file = path(option == std::string(" --out ") ? "regions.yaml" : "regions.png");
    const auto outcome = tests::run_apart("regions " + path("none.mp4") + option + file);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, HasSubstr(file + ": exists; name another file, or --force"));
    EXPECT_EQ(tests::read(file), "mine");
  }
}

}  // namespace
