// A run that is recorded and replayed.
#ifdef HOVERMODAL_WITH_LCM
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <stdexcept>
#include <stop_token>
#include <thread>

#include "drivers/telemetry/record_folder.h"
#include "drivers/telemetry/sample_sender.h"
#include "firmware_app/replay/analysis.h"
#include "firmware_app/report/modal_json.h"
#include "tests/support/loopback_network.h"
#include "tests/support/pipeline_rig.h"

namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using tests::CameraScript;
using tests::frames;
using tests::Rig;

class PipelineRecord : public ::testing::Test {
 protected:
  // Runs with a report and a record; returns the record's first file.
  std::string run(const CameraScript& script, const std::string& name, std::vector<std::string> more = {}) {
    more.insert(more.end(), {"spectrum.segment=64", "record.directory=" + (folder / name).string(),
                             "report.directory=" + (folder / (name + "_live")).string()});
    Rig rig(script, more);
    outcome = rig.run();
    const auto parts = drivers::record_parts((folder / name).string());
    EXPECT_FALSE(parts.empty());
    return parts.empty() ? "" : parts.front().path;
  }
  app::RecordsResult replayed(const std::vector<std::string>& records, const std::string& name,
                              const std::vector<std::string>& overrides = {}) {
    const fs::path again = folder / (name + "_again");
    fs::create_directories(again);
    return app::replay_records(records, {"", overrides}, again.string());
  }
  void expect_same_report(const std::string& name) {
    for (const char* file : {"modal.json", "displacements.csv", "tracks.csv", "closure.json"})
      EXPECT_EQ(text_of(name + "_live", file), text_of(name + "_again", file)) << file;
  }
  std::string text_of(const std::string& report, const char* file) const {
    return tests::file_text(folder / report / file);
  }

  fs::path folder = tests::own_folder();
  app::Pipeline::Outcome outcome;
};

TEST_F(PipelineRecord, IsReplayedToTheSameBits) {
  const std::string record = run(frames(400), "plain");
  const auto result = replayed({record}, "plain");
  EXPECT_THAT(result.remarks, Contains(HasSubstr("cut off")));  // this publisher writes no final message
  EXPECT_FALSE(result.tracks.estimate.modes.empty());
  expect_same_report("plain");
  EXPECT_TRUE(fs::exists(folder / "plain_again" / "frame.png"));  // the record holds the first image
}

TEST_F(PipelineRecord, ARunWithLostFramesToo) {
  CameraScript script = frames(400);
  script.is_lost = [](std::uint64_t k) { return k >= 150 && k < 163; };
  const std::string record = run(script, "gaps");
  (void)replayed({record}, "gaps");
  expect_same_report("gaps");
}

// The states that the service received live are in the record, before the same frames.
TEST_F(PipelineRecord, ARunThatHearsTheAircraftToo) {
  SKIP_WITHOUT_PRIVATE_LOOPBACK();
  constexpr const char* kUrl = "udpm://239.255.76.67:7667?ttl=0";
  std::jthread sender([&](const std::stop_token& stop) {
    drivers::SampleSender out(kUrl, "AIRCRAFT");
    core::AircraftState state;
    for (int k = 0; !stop.stop_requested(); ++k) {
      state.motor_hz[0] = 95.0 + 0.01 * (k % 7), state.motor_hz[1] = 97.0;
      state.latitude_deg = 47.5 + 1e-7 * k, state.longitude_deg = 8.25, state.wind_m_s = 4.0,
      state.wind_from_deg = 310.0;
      (void)out.send(state);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  CameraScript script = frames(400);
  script.frame_time = std::chrono::microseconds(1000);
  const std::string record =
      run(script, "aircraft", {"camera.aircraft_channel=AIRCRAFT", std::string("telemetry.lcm_url=") + kUrl});
  sender.request_stop();
  (void)replayed({record}, "aircraft");
  expect_same_report("aircraft");
  const app::ModalReport report = app::read_modal_json((folder / "aircraft_live" / "modal.json").string());
  EXPECT_GE(report.aircraft.n_states, 20U);
  ASSERT_EQ(report.aircraft.motors.size(), 2U);
  EXPECT_NEAR(report.aircraft.motors[0].hz, 95.03, 0.02);
  ASSERT_TRUE(report.aircraft.place && report.aircraft.wind);
  EXPECT_NEAR(report.aircraft.place->longitude_deg, 8.25, 1e-9);
  EXPECT_THAT(text_of("aircraft_live", "report.html"),
              HasSubstr("8.250000 E; wind 4.0 m/s from 310 degrees; motors at 95."));
}

// Includes reports of residual diagnosis, with and without corrections. A lens is declared that does not exist.
TEST_F(PipelineRecord, ARunThatClosesTheLoopToo) {
  for (const std::string adopt : {"report", "auto"}) {
    const std::string record =
        run(frames(1500), adopt,
            {"closure.adopt=" + adopt, "closure.period_s=20", "closure.window_s=24", "closure.delay_s=4",
             "calibration.distortion=[0.2, 0, 0, 0]", "closure.points_per_region=5"});
    const auto result = replayed({record}, adopt);
    EXPECT_EQ(result.tracks.estimate.amendments.size(), adopt == "auto" ? 1U : 0U);
    EXPECT_TRUE(fs::exists(folder / (adopt + "_live") / "closure.json"));
    expect_same_report(adopt);
  }
}

// A live source does not wait for the report: the correction begins late. The modes do not depend on when, because the
// run is measured again from its start.
TEST_F(PipelineRecord, ALiveRunThatClosesTheLoopHasTheModesOfItsReplay) {
  CameraScript script = frames(1500);
  script.lossless = false;
  script.frame_time = std::chrono::microseconds(2000);
  script.is_dark = [](std::uint64_t k) {
    if (k > 1000) std::this_thread::sleep_for(std::chrono::milliseconds(25));
    return false;
  };
  const std::string record =
      run(script, "live",
          {"closure.adopt=auto", "closure.period_s=20", "closure.window_s=24", "closure.delay_s=1",
           "calibration.distortion=[0.2, 0, 0, 0]", "closure.points_per_region=5", "rt.thin_overload=false"});
  ASSERT_EQ(outcome.estimate.amendments.size(), 1U) << "the report came before the end";
  const auto result = replayed({record}, "live");
  const core::ModalEstimate &live = outcome.estimate, &again = result.tracks.estimate;
  EXPECT_EQ(live.n_samples, again.n_samples);
  ASSERT_EQ(live.modes.size(), again.modes.size());
  for (std::size_t m = 0; m < live.modes.size(); ++m) {
    EXPECT_EQ(live.modes[m].frequency_hz, again.modes[m].frequency_hz);
    EXPECT_EQ(live.modes[m].shape, again.modes[m].shape);
  }
}

// The service masks at most two segments of the gap; so does the replay, whatever times the record states.
TEST_F(PipelineRecord, ARunWithAGapOfManySegmentsToo) {
  CameraScript script = frames(900);
  script.is_lost = [](std::uint64_t k) { return k >= 150 && k < 700; };
  const std::string record = run(script, "long_gap");
  (void)replayed({record}, "long_gap");
  expect_same_report("long_gap");
}

// Interrupted after 300 frames; the next run resumes from its state, which is contained in that run's record.
TEST_F(PipelineRecord, ARunThatWentOnWithAKeptStateToo) {
  const std::vector<std::string> keeps = {"state.period_s=2", "state.directory=" + (folder / "state").string()};
  CameraScript cut_off = frames(400);
  cut_off.fault_at = 300;
  (void)run(cut_off, "before", keeps);
  ASSERT_TRUE(fs::exists(folder / "state" / "hovermodal.state"));
  const std::string record = run(frames(200), "resumed", keeps);
  ASSERT_GE(outcome.estimate.n_samples, 250U + 64U + 200U) << "it went on";
  const auto result = replayed({record}, "resumed");
  EXPECT_EQ(result.tracks.estimate.n_samples, outcome.estimate.n_samples);
  EXPECT_THAT(result.remarks, Not(Contains(HasSubstr("resumed from a state"))));
  expect_same_report("resumed");

  const auto other = replayed({record}, "other", {"spectrum.segment=32"});
  EXPECT_THAT(other.remarks, Contains(HasSubstr("resumed from a state")));
  EXPECT_EQ(other.tracks.estimate.n_samples, 200U);
}

// From the first thinned frame on, new spectra begin in the replay, too. Frames dropped before the
// tracker are reported in the run's last message, which this publisher does not write.
TEST_F(PipelineRecord, ARunUnderOverloadToo) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "instrumented tracking follows one frame in sixty: too few are left to compare";
#endif
  const std::string record =
      run(tests::too_fast(1500), "overload",
          {"rt.frame_slots=4", "rt.sample_slots=2048", "identification.period=1000", "closure.adopt=off"});
  ASSERT_LT(outcome.health.rate_hz, 25.0) << "it was too fast";
  const auto result = replayed({record}, "overload");
  EXPECT_DOUBLE_EQ(result.tracks.estimate.rate_hz, outcome.estimate.rate_hz);
  EXPECT_EQ(result.tracks.losses.frames_processed, outcome.health.frames_processed);
  for (const char* file : {"displacements.csv", "tracks.csv"})
    EXPECT_EQ(text_of("overload_live", file), text_of("overload_again", file)) << file;
  const auto without_losses = [](const std::string& text) { return text.substr(0, text.find("\"losses\"")); };
  EXPECT_EQ(without_losses(text_of("overload_live", "modal.json")),
            without_losses(text_of("overload_again", "modal.json")));
}

TEST_F(PipelineRecord, AConfigurationWithoutItsRegionsIsRefused) {
  const std::string record = run(frames(200), "whole");
  const fs::path other = folder / "other.yaml";
  std::ofstream(other) << "camera: {source: a.mp4}\nregions: [{name: only, rect: [0, 0, 30, 30]}]\n";
  try {
    (void)app::replay_records({record}, {other.string(), {}}, "");
    FAIL() << "points of regions that are not there were taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("does not belong to the 1 regions of the configuration"));
  }
}

TEST_F(PipelineRecord, AnOverrideChangesTheResult) {
  const std::string record = run(frames(300), "other");
  const auto same = replayed({record}, "other"), other = replayed({record}, "other", {"spectrum.segment=32"});
  EXPECT_NE(same.tracks.estimate.n_segments, other.tracks.estimate.n_segments);
}

TEST_F(PipelineRecord, SeveralRunsOfOneViewAddUp) {
  const std::string first = run(frames(300), "one"), second = run(frames(200), "two");
  const auto alone = replayed({first}, "one"), both = replayed({first, second}, "both");
  EXPECT_GE(both.tracks.estimate.n_samples, 300U + 200U);
  EXPECT_GT(both.tracks.estimate.n_segments, alone.tracks.estimate.n_segments);
  EXPECT_EQ(both.tracks.losses.frames_in, 500U);
}

TEST_F(PipelineRecord, RunsOfOtherViewsAreRefused) {
  const std::string first = run(frames(200), "one"), second = run(frames(200), "two", {"regions.0.name=elsewhere"});
  try {
    (void)replayed({first, second}, "both");
    FAIL() << "taken";
  } catch (const std::invalid_argument& refused) {
    EXPECT_THAT(refused.what(), HasSubstr("replay them one by one"));
  }
}

}  // namespace
#endif
