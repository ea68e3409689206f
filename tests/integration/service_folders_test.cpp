// What refused, second and killed services leave of a report.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "tests/support/pipeline_run.h"
#include "tests/support/service_run.h"
#include "tests/support/test_clip.h"

namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using tests::own_folder;
using tests::run_service;
using tests::ServiceRun;

// A run of the simulated clip without telemetry.
std::vector<std::string> folder_run(const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"--config", (tests::simulated_folder() / "config.yaml").string(),
                                     "--set",    "telemetry.lcm_url=",
                                     "--set",    "spectrum.segment=128"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(ServiceFolders, ARunThatIsRefusedTouchesNothingOfTheLastReport) {
  const auto folder = own_folder();
  fs::create_directories(folder);
  std::ofstream(folder / "modal.json") << "good";
  const ServiceRun run = run_service(
      folder_run({"--set", "rt.capture_cpu=1023", "--set", "rt.required=true", "--report", folder.string()}));
  EXPECT_EQ(run.code, 4) << run.output;
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

TEST(ServiceFolders, AWrongStructureEndsItBeforeTheFirstFrame) {
  const auto folder = own_folder();
  fs::create_directories(folder);
  std::ofstream(folder / "tower.yaml") << "structure: {kind: tower, height_m: -3}\n";
  for (const char* file : {"tower.yaml", "none.yaml"}) {
    const ServiceRun wrong = run_service(
        folder_run({"--set", "closure.structure=" + (folder / file).string(), "--report", folder.string()}));
    EXPECT_EQ(wrong.code, 2) << wrong.output;
    EXPECT_THAT(wrong.output, HasSubstr("closure.structure"));
    EXPECT_THAT(wrong.output, HasSubstr(file));
  }
}

TEST(ServiceFolders, ASecondOneInAFolderIsExitCode2AndARunThatIsKilledLeavesTheLastReport) {
  const auto folder = own_folder();
  fs::create_directories(folder);
  std::ofstream(folder / "modal.json") << "good";
  std::vector<std::string> arguments{tests::kService};
  for (const std::string& a : folder_run({"--set", "camera.pace=realtime", "--report", folder.string()}))
    arguments.push_back(a);
  tests::ChildProcess first(arguments);
  ASSERT_TRUE(first.wait_for("channel base")) << first.output();
  tests::ChildProcess second(arguments);
  EXPECT_EQ(second.wait_for_exit(), 2) << second.output();
  EXPECT_THAT(second.output(), HasSubstr("report.directory: " + folder.string() + ": is in use by process"));
  std::this_thread::sleep_for(std::chrono::milliseconds(2500));
  first.signal(SIGKILL);
  (void)first.wait_for_exit();
  EXPECT_EQ(fs::file_size(folder / "modal.json"), 4U);
  const ServiceRun next = run_service(folder_run({"--report", folder.string()}));
  EXPECT_EQ(next.code, 0) << next.output;
  EXPECT_TRUE(tests::json_of(folder / "modal.json").is_object());
  EXPECT_EQ(fs::file_size(folder / "report.1" / "modal.json"), 4U);
  EXPECT_TRUE(fs::exists(folder / "report.unfinished" / "displacements.csv.partial"));
}

}  // namespace
