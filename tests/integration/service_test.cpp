// The service as a program: its command line, exit codes, signals, and output files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include "firmware_app/report/page/report_page.h"
#include "tests/support/loopback_network.h"
#include "tests/support/pipeline_run.h"
#include "tests/support/service_run.h"
#include "tests/support/test_clip.h"

namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using tests::own_folder;
using tests::run_service;
using tests::ServiceRun;

constexpr const char* kReportFiles[] = {"modal.json", "tracks.csv", "displacements.csv"};

// A run of the simulated clip without telemetry.
std::vector<std::string> clip_arguments(const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"--config", (tests::simulated_folder() / "config.yaml").string(),
                                     "--set",    "telemetry.lcm_url=",
                                     "--set",    "spectrum.segment=128"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

void expect_complete_report(const fs::path& folder) {
  for (const char* name : kReportFiles) {
    EXPECT_TRUE(fs::exists(folder / name)) << name;
    EXPECT_FALSE(fs::exists(folder / (std::string(name) + ".partial"))) << name;
  }
  const auto modal = tests::json_of(folder / "modal.json");
  ASSERT_TRUE(modal.is_object());
  const auto& losses = modal["losses"];
  EXPECT_EQ(losses["frames_in"].get<int>(),
            losses["frames_processed"].get<int>() + losses["frames_dropped"].get<int>());
  const std::string displacements = tests::file_text(folder / "displacements.csv");
  EXPECT_EQ(displacements.empty() ? '?' : displacements.back(), '\n');
}

TEST(Service, AnswersHelpAndVersionWithoutRunning) {
  const ServiceRun help = run_service({"--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_THAT(help.output, AllOf(HasSubstr("--config"), HasSubstr("--set"), HasSubstr("--report"), HasSubstr("--check"),
                                 HasSubstr("Exit codes")));
  const ServiceRun version = run_service({"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_THAT(version.output, HasSubstr("hovermodald 0."));
  const ServiceRun keys = run_service({"--help-config"});
  EXPECT_EQ(keys.code, 0);
  for (const char* key : {"method", "source", "rate_hz", "readout_ms", "rect", "known_length_mm", "segment", "period",
                          "lcm_url", "directory", "required"}) {
    EXPECT_THAT(keys.output, HasSubstr(key));
  }
}

TEST(Service, WrongUsageIsExitCode2AndSaysWhatToDo) {
  const auto folder = own_folder();
  EXPECT_EQ(run_service({}).code, 2);
  EXPECT_THAT(run_service({}).output, HasSubstr("--help"));
  EXPECT_EQ(run_service({"--no-such-option"}).code, 2);
  EXPECT_EQ(run_service({"--config"}).code, 2);
  const ServiceRun missing = run_service({"--config", (folder / "none.yaml").string()});
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.output, HasSubstr("none.yaml"));
  const ServiceRun unknown = run_service(clip_arguments({"--set", "spectrum.segmnt=128"}));
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.output, AllOf(HasSubstr("spectrum.segmnt"), HasSubstr("segment")));
}

TEST(Service, CheckLooksAtConfigurationAndSourceAndLeavesNothing) {
  const auto folder = own_folder();
  const ServiceRun good = run_service(clip_arguments({"--check", "--report", (folder / "report").string()}));
  EXPECT_EQ(good.code, 0) << good.output;
  EXPECT_FALSE(fs::exists(folder / "report"));
  EXPECT_THAT(good.output,
              AllOf(HasSubstr("noise expected"), HasSubstr("mm per px"), HasSubstr("times: Frames lie 1/25 s apart"),
                    HasSubstr("readout: 26 ms of a frame of 40 ms")));
  EXPECT_THAT(good.output, ::testing::Not(::testing::AnyOf(HasSubstr("warning: scale"), HasSubstr("warning: camera"))));
  const ServiceRun slips = run_service(
      clip_arguments({"--check", "--set", "scale.known_length_mm=0.84", "--set", "camera.readout_ms=0.026"}));
  EXPECT_EQ(slips.code, 0) << slips.output;
  EXPECT_THAT(slips.output, AllOf(HasSubstr("metres instead of mm?"), HasSubstr("seconds? Then it is 26 ms")));
  const ServiceRun slow = run_service(clip_arguments({"--check", "--set", "camera.readout_ms=1000"}));
  EXPECT_EQ(slow.code, 2) << slow.output;
  EXPECT_THAT(slow.output, AllOf(HasSubstr("camera.readout_ms: 1000 is refused"), HasSubstr("40 ms at 25 Hz")));
  EXPECT_EQ(run_service(clip_arguments({"--check", "--set", "camera.source=none.mp4"})).code, 3);
  const ServiceRun bad = run_service(clip_arguments({"--check", "--set", "spectrum.segment=4096"}));
  EXPECT_EQ(bad.code, 2);
  EXPECT_THAT(bad.output, AllOf(HasSubstr("spectrum.segment"), HasSubstr("163.8 s")));
}

TEST(Service, WatchesAClipAndLeavesItsReport) {
  const auto folder = own_folder();
  const ServiceRun run = run_service(clip_arguments({"--report", folder.string()}));
  EXPECT_EQ(run.code, 0) << run.output;
  EXPECT_THAT(run.output, HasSubstr("600 frames in = 600 processed + 0 dropped"));
  expect_complete_report(folder);
  const auto modal = tests::json_of(folder / "modal.json");
  EXPECT_EQ(modal["samples"], 600);
  EXPECT_EQ(modal["segments"], 9);  // 1 + (600 - 128) / 64, and the remainder
}

TEST(Service, TheSameClipTwiceGivesTheSameBytes) {
  const auto folder = own_folder();
  for (const char* name : {"first", "second"}) {
    EXPECT_EQ(run_service(clip_arguments({"--report", (folder / name).string()})).code, 0);
  }
  for (const char* name : kReportFiles) {
    const std::string text = tests::file_text(folder / "first" / name);
    EXPECT_GT(text.size(), 1000U) << name;
    EXPECT_TRUE(text == tests::file_text(folder / "second" / name)) << name;
  }
  const auto page = [&](const char* name) {
    const std::string text = tests::file_text(folder / name / app::kReportName);
    return text.substr(0, text.find(app::kVariesBegin)) + text.substr(text.find(app::kVariesEnd));
  };
  EXPECT_GT(page("first").size(), 50'000U);
  EXPECT_TRUE(page("first") == page("second"));
}

TEST(Service, AReplayOfItsTracksFollowsTheSameModes) {
  const auto folder = own_folder();
  EXPECT_EQ(run_service(clip_arguments({"--set", "spectrum.segment=256", "--set", "identification.period=1", "--report",
                                        (folder / "run").string()}))
                .code,
            0);
  tests::ChildProcess replay({tests::kTools, "replay", "--tracks", (folder / "run" / "tracks.csv").string(), "--config",
                              (tests::simulated_folder() / "config.yaml").string(), "--set", "spectrum.segment=256",
                              "--set", "identification.period=1", "--report", (folder / "replay").string()});
  EXPECT_EQ(replay.wait_for_exit(), 0) << replay.output();
  const auto first = tests::json_of(folder / "run" / "modal.json")["modes"];
  const auto again = tests::json_of(folder / "replay" / "modal.json")["modes"];
  ASSERT_EQ(first.size(), again.size());
  int n_followed = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_NEAR(first[i]["frequency_hz"].get<double>(), again[i]["frequency_hz"].get<double>(), 1e-3);
    ASSERT_EQ(first[i]["history"].is_null(), again[i]["history"].is_null());
    if (first[i]["history"].is_null()) continue;
    ++n_followed;
    for (const char* key : {"id", "estimates", "first_estimate"}) {
      EXPECT_EQ(first[i]["history"][key], again[i]["history"][key]) << key;
    }
  }
  EXPECT_GT(n_followed, 0);
}

TEST(Service, LaterSettingsOverrideEarlierOnes) {
  const auto folder = own_folder();
  const ServiceRun run = run_service(clip_arguments(
      {"--set", "spectrum.segment=256", "--set", "report.tracks=false", "--report", (folder / "a b: 1").string()}));
  EXPECT_EQ(run.code, 0) << run.output;
  EXPECT_EQ(tests::json_of(folder / "a b: 1" / "modal.json")["segments"], 4);
  EXPECT_FALSE(fs::exists(folder / "a b: 1" / "tracks.csv"));
}

class ServiceSignal : public ::testing::TestWithParam<int> {};

TEST_P(ServiceSignal, EndsARunWellWithACompleteReport) {
  const auto folder = own_folder();
  std::vector<std::string> arguments{tests::kService};
  for (const std::string& a : clip_arguments({"--set", "camera.pace=realtime", "--report", folder.string()}))
    arguments.push_back(a);
  tests::ChildProcess service(arguments);
  ASSERT_TRUE(service.wait_for("channel base")) << service.output();
  std::this_thread::sleep_for(std::chrono::milliseconds(800));
  service.signal(GetParam());
  EXPECT_EQ(service.wait_for_exit(), 0) << service.output();
  expect_complete_report(folder);
  const auto modal = tests::json_of(folder / "modal.json");
  EXPECT_GT(modal["samples"].get<int>(), 0);
  EXPECT_LT(modal["samples"].get<int>(), 600);
  EXPECT_THAT(service.output(), HasSubstr("fewer than one segment of 128"));
}

INSTANTIATE_TEST_SUITE_P(Interrupts, ServiceSignal, ::testing::Values(SIGINT, SIGTERM, SIGHUP));

// Block rows near the lags that a segment has: one estimate takes some seconds. The signal comes soon after its
// beginning. The report is that of the run without it; the comparison of the declared structure, which waits for it, is
// not waited for.
TEST_P(ServiceSignal, EndsARunInALongEstimateWithACompleteReport) {
  const auto folder = own_folder();
  const std::string structure = (folder / "frame.yaml").string();
  tests::write_text_file(structure, "structure: {kind: shear_frame, storeys: 6}\n");
  std::vector<std::string> arguments{tests::kService};
  for (const std::string& a : clip_arguments({"--set", "closure.structure=" + structure, "--set",
                                              "spectrum.segment=512", "--set", "identification.block_rows=200", "--set",
                                              "identification.period=1", "--report", folder.string()}))
    arguments.push_back(a);
  tests::ChildProcess service(arguments);
  ASSERT_TRUE(service.wait_for("channel base")) << service.output();
  ASSERT_TRUE(service.wait_until_busy("hm-identify", 0.2)) << service.output();
  service.signal(GetParam());
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(service.wait_for_exit(), 0) << service.output();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
  expect_complete_report(folder);
  EXPECT_THAT(service.output(), HasSubstr("did not end in time is left out"));
  EXPECT_THAT(tests::file_text(folder / "modal.json"), HasSubstr("stopped during an estimate"));
}

TEST(Service, AFaultInMidRunIsExitCode1AndFlushesWhatCameBefore) {
  const auto folder = own_folder();
  const auto images = folder / "images";
  test_support::write_image_folder(images, {.n_frames = 60, .width_px = 128, .height_px = 96});
  test_support::write_text(images / "frame_40.png", "damaged");
  tests::write_text_file(folder / "config.yaml", "camera: {source: '" + images.string() + "', rate_hz: 25}\n" +
                                                     "regions: [{name: roof, rect: [20, 20, 80, 50]}]\n"
                                                     "spectrum: {segment: 32}\ntelemetry: {lcm_url: ''}\n");
  const ServiceRun run =
      run_service({"--config", (folder / "config.yaml").string(), "--report", (folder / "out").string()});
  EXPECT_EQ(run.code, 1) << run.output;
  EXPECT_THAT(run.output, AllOf(HasSubstr("frame_40.png"), HasSubstr("40 frames in = 40 processed")));
  expect_complete_report(folder / "out");
}

TEST(Service, AMissingDeviceIsExitCode3) {
  for (const char* driver : {"file", "v4l2", "libcamera"}) {
    const ServiceRun run = run_service(
        clip_arguments({"--set", std::string("camera.driver=") + driver, "--set", "camera.source=not_there"}));
    EXPECT_EQ(run.code, 3) << run.output;
    EXPECT_THAT(run.output, HasSubstr("not_there"));
  }
  const ServiceRun run =
      run_service(clip_arguments({"--set", "camera.driver=stream", "--set", "camera.source=tcp://127.0.0.1:9"}));
  EXPECT_EQ(run.code, 3) << run.output;
  EXPECT_THAT(run.output, AllOf(HasSubstr("127.0.0.1:9"), HasSubstr("ffplay")));
}

// A command that starts a program without the right to real-time priorities; empty if that is impossible here.
std::vector<std::string> without_realtime_rights() {
  std::vector<std::string> before;
  if (geteuid() == 0) before = {"/usr/bin/setpriv", "--bounding-set=-sys_nice", "--inh-caps=-sys_nice"};
  for (const char* word : {"/usr/bin/prlimit", "--rtprio=0:0"}) before.emplace_back(word);
  for (const char* program : {"/usr/bin/setpriv", "/usr/bin/prlimit"}) {
    if (!fs::exists(program)) return {};
  }
  std::vector<std::string> probe = before;
  probe.insert(probe.end(), {"/usr/bin/chrt", "-f", "10", "/bin/true"});
  if (tests::ChildProcess(probe).wait_for_exit() != 1) return {};  // not refused
  return before;
}

#define SKIP_WHEN_REALTIME_CANNOT_BE_REFUSED(before) \
  if ((before).empty())                              \
  GTEST_SKIP() << "needs setpriv, prlimit and chrt (util-linux) and the right to drop CAP_SYS_NICE"

TEST(Service, RefusedRealTimeIsExitCode4WhereItIsRequired) {
  const auto before = without_realtime_rights();
  SKIP_WHEN_REALTIME_CANNOT_BE_REFUSED(before);
  const ServiceRun run = run_service(clip_arguments({"--set", "rt.required=true", "--set", "rt.priority=50"}), before);
  EXPECT_EQ(run.code, 4) << run.output;
  EXPECT_THAT(run.output, AllOf(HasSubstr("CAP_SYS_NICE"), HasSubstr("rt.required")));
}

TEST(Service, RefusedRealTimeIsAWarningWhereItIsNotRequired) {
  const auto before = without_realtime_rights();
  SKIP_WHEN_REALTIME_CANNOT_BE_REFUSED(before);
  const auto folder = own_folder();
  const ServiceRun run = run_service(clip_arguments({"--set", "rt.priority=50", "--report", folder.string()}), before);
  EXPECT_EQ(run.code, 0) << run.output;
  EXPECT_THAT(run.output, AllOf(HasSubstr("priority 50 refused"), HasSubstr("CAP_SYS_NICE")));
  expect_complete_report(folder);
}

#ifdef HOVERMODAL_WITH_LCM
TEST(Service, ASecondProcessHearsEveryMessageOfARun) {
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  const auto folder = own_folder();
  tests::ChildProcess spy({tests::kTools, "spy", "--once", "--plain", "--count", (folder / "count.json").string()});
  ASSERT_TRUE(spy.wait_for("listening on")) << spy.output();
  const ServiceRun run = run_service(clip_arguments({"--set", "telemetry.lcm_url=udpm://239.255.76.67:7667?ttl=0"}));
  EXPECT_EQ(run.code, 0) << run.output;
  EXPECT_EQ(spy.wait_for_exit(), 0) << spy.output();
  const auto count = tests::json_of(folder / "count.json");
  EXPECT_TRUE(count["complete"].get<bool>()) << count.dump(2);
  EXPECT_EQ(count["channels"]["HOVERMODAL_DISPLACEMENT"]["received"], 600);
}

TEST(Service, AUrlWithoutARouteSaysHowToMendIt) {
  if (const std::string why = tests::enter_private_network(false); !why.empty()) GTEST_SKIP() << why;
  const ServiceRun run = run_service(clip_arguments({"--set", "telemetry.lcm_url=udpm://239.255.76.67:7667?ttl=0"}));
  EXPECT_NE(run.code, 0) << run.output;
  EXPECT_LT(run.code, 128) << run.output;
  EXPECT_THAT(run.output, AllOf(HasSubstr("239.255.76.67"), HasSubstr("ip route add")));
}
#endif

}  // namespace
