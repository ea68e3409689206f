// The pipeline under overload, faults, gaps, darkness and sudden ends: every loss is counted, nothing hangs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/support/pipeline_rig.h"

namespace {

using ::testing::HasSubstr;
using tests::CameraScript;
using tests::frames;
using tests::Heard;
using tests::kChannels;
using tests::kShortClip;
using tests::Rig;

// Channel samples that the spectrum must have masked, from the published samples: all of them if the
// ring of records lost none.
std::uint64_t expected_masked(const Heard& heard) {
  std::uint64_t masked = 0;
  for (std::size_t i = 0; i < heard.samples.size(); ++i) {
    const auto& seen = heard.samples[i].seen;
    for (const std::uint8_t s : seen) masked += s == 0 ? 1U : 0U;
    if (i > 0) masked += (heard.samples[i].sequence - heard.samples[i - 1].sequence - 1) * seen.size();
  }
  return masked;
}

TEST(PipelineTrouble, OverloadDropsFramesCountsThemAndMasksTheGaps) {
  CameraScript script = frames(400);
  script.lossless = false;
  script.frame_time = std::chrono::microseconds(100);
  // All samples find room after tracking, however late spectrum gets its processor.
  Rig rig(script, {"spectrum.segment=64", "rt.frame_slots=2", "rt.sample_slots=512", "rt.thin_overload=false"});
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.fault, "");
  EXPECT_EQ(outcome.health.frames_in, 400U);
  EXPECT_GT(outcome.health.frames_dropped, 0U);
  EXPECT_EQ(outcome.health.frames_missing, 0U);  // they reached the service
  ASSERT_EQ(rig.heard->samples.size(), outcome.health.frames_processed);
  const auto expected = expected_masked(*rig.heard);
  EXPECT_GT(expected, 0U);
  EXPECT_EQ(outcome.health.samples_masked, expected);
  EXPECT_EQ(outcome.estimate.n_samples, rig.heard->samples.back().sequence + 1);
  for (std::size_t i = 1; i < rig.heard->samples.size(); ++i) {
    const auto& [before, now] = std::pair{rig.heard->samples[i - 1], rig.heard->samples[i]};
    EXPECT_EQ(now.gap_before, now.sequence != before.sequence + 1) << "frame " << now.sequence;
  }
  ASSERT_FALSE(rig.heard->health.empty());
  const core::Health& last = rig.heard->health.back();
  EXPECT_EQ(last.state, "finished");
  EXPECT_EQ(last.frames_dropped, outcome.health.frames_dropped);
  EXPECT_EQ(last.samples_masked, outcome.health.samples_masked);
}

TEST(PipelineTrouble, ASlowPublisherCostsALiveSourceCountedRecordsAndNothingElse) {
  CameraScript script = frames(200);
  script.lossless = false;
  script.frame_time = std::chrono::milliseconds(5);
  Rig rig(script, {"spectrum.segment=64", "rt.sample_slots=2", "rt.frame_slots=256"}, kShortClip,
          {false, std::chrono::milliseconds(200)});  // slower than any tracking, instrumented or not
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.health.frames_processed, 200U);
  EXPECT_LT(rig.heard->samples.size(), 200U);
  EXPECT_EQ(outcome.estimate.n_samples, 200U);
  const core::StageHealth& publish = outcome.health.stages.back();
  EXPECT_EQ(publish.name, "publish");
  EXPECT_EQ(publish.n_dropped, 200U - rig.heard->samples.size());
}

TEST(PipelineTrouble, ASlowPublisherMakesAFileWait) {
  Rig rig(frames(120), {"spectrum.segment=64", "rt.sample_slots=2", "rt.frame_slots=2"}, kShortClip,
          {false, std::chrono::milliseconds(5)});
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.health.frames_processed, 120U);
  EXPECT_EQ(outcome.health.frames_dropped, 0U);
  EXPECT_EQ(rig.heard->samples.size(), 120U);
}

TEST(PipelineTrouble, ACameraFaultFlushesAllThatCameBefore) {
  const auto folder = tests::own_folder();
  CameraScript script = frames(300);
  script.fault_at = 130;
  Rig rig(script, {"spectrum.segment=64", "report.directory=" + folder.string()});
  const auto outcome = rig.run();
  EXPECT_THAT(outcome.fault, HasSubstr("the cable came off"));
  EXPECT_EQ(outcome.health.frames_processed, 130U);
  EXPECT_EQ(rig.heard->samples.size(), 130U);
  EXPECT_EQ(outcome.estimate.n_samples, 130U);
  EXPECT_TRUE(outcome.estimate.final);
  ASSERT_FALSE(rig.heard->health.empty());
  EXPECT_THAT(rig.heard->health.back().state, HasSubstr("the cable came off"));
  for (const char* name : {"modal.json", "tracks.csv", "displacements.csv"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  }
  EXPECT_THAT(tests::file_text(folder / "displacements.csv"), HasSubstr("\n129,"));
}

TEST(PipelineTrouble, ACameraThatFaultsOnItsFirstFrameIsRefusedAtSetUp) {
  CameraScript script = frames(300);
  script.fault_at = 0;
  try {
    Rig rig(script);
    FAIL() << "accepted";
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), HasSubstr("the cable came off"));
  }
}

TEST(PipelineTrouble, AnEmptyStreamIsRefusedAtSetUp) {
  CameraScript script = frames(0);
  EXPECT_THROW(Rig{script}, std::runtime_error);
}

TEST(PipelineTrouble, SitsOutACameraThatIsSilentForAWhile) {
  CameraScript script = frames(150);
  script.silent_before = 70;
  script.n_timeouts = 40;
  Rig rig(script);
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.fault, "");
  EXPECT_EQ(outcome.health.frames_processed, 150U);
  EXPECT_EQ(outcome.health.frames_missing, 0U);
}

TEST(PipelineTrouble, StopsWhileTheCameraIsSilent) {
  CameraScript script = frames(150);
  script.silent_before = 70;
  script.n_timeouts = 1'000'000;
  Rig rig(script);
  rig.pipeline->start();
  while (rig.pipeline->health().frames_processed < 70) {
    ASSERT_TRUE(rig.pipeline->running());
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  rig.pipeline->request_stop();
  EXPECT_EQ(rig.finish().health.frames_processed, 70U);
}

TEST(PipelineTrouble, MasksWhatTheSourceSkipsAndCountsItAsMissing) {
  CameraScript script = frames(300);
  script.is_lost = [](std::uint64_t k) { return k % 11 == 5 || (k >= 100 && k < 120); };
  std::uint64_t n_lost = 0;
  for (std::uint64_t k = 0; k < 300; ++k) n_lost += script.is_lost(k) ? 1U : 0U;
  Rig rig(script);
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.health.frames_missing, n_lost);
  EXPECT_EQ(outcome.health.frames_processed, 300 - n_lost);
  EXPECT_EQ(outcome.health.samples_masked, expected_masked(*rig.heard));
  EXPECT_GE(outcome.health.samples_masked, n_lost * kChannels);
  EXPECT_EQ(outcome.estimate.n_samples, 300U);
}

TEST(PipelineTrouble, SurvivesDarknessInTheMiddleAndSeesAgain) {
  const auto folder = tests::own_folder();
  CameraScript script = frames(150);
  script.is_dark = [](std::uint64_t k) { return k >= 60 && k < 90; };
  Rig rig(script, {"spectrum.segment=64", "report.directory=" + folder.string()});
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.fault, "");
  EXPECT_EQ(outcome.health.frames_processed, 150U);
  EXPECT_GE(outcome.health.samples_masked, 30U * kChannels);
  for (std::size_t c = 0; c < kChannels; ++c) {
    EXPECT_EQ(rig.heard->samples[75].seen[c], 0);
    EXPECT_EQ(rig.heard->samples[140].seen[c], 1);
  }
  for (const char* name : {"modal.json", "tracks.csv", "displacements.csv"}) {
    const std::string text = tests::file_text(folder / name);
    EXPECT_EQ(text.find("nan"), text.npos) << name;
    EXPECT_EQ(text.find("inf,"), text.npos) << name;
  }
}

TEST(PipelineTrouble, DarknessToTheEndIsAnEstimateWithoutModesOrNaN) {
  CameraScript script = frames(150);
  script.is_dark = [](std::uint64_t k) { return k >= 1; };
  Rig rig(script);
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.fault, "");
  EXPECT_TRUE(outcome.estimate.modes.empty());
  EXPECT_NE(outcome.estimate.status, "ok");
}

TEST(PipelineTrouble, RefusesRepeatedAndBackwardTimesAndCountsThem) {
  CameraScript script = frames(150);
  script.time_ns = [](std::uint64_t k) {
    const std::uint64_t told = k == 50 ? 49 : k == 80 ? 20 : k;  // repeated, backward
    return static_cast<std::int64_t>(told) * 40'000'000;
  };
  Rig rig(script);
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.health.stages.at(2).name, "spectrum");
  EXPECT_EQ(outcome.health.stages.at(2).n_dropped, 2U);
  EXPECT_EQ(outcome.health.samples_masked, expected_masked(*rig.heard) + 2 * kChannels);
  EXPECT_EQ(outcome.estimate.n_samples, 150U);
}

TEST(PipelineTrouble, StoppedBeforeItStartsItEndsEmptyAndComplete) {
  const auto folder = tests::own_folder();
  Rig rig(frames(150), {"spectrum.segment=64", "report.directory=" + folder.string()});
  rig.pipeline->request_stop();
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.fault, "");
  EXPECT_EQ(outcome.health.frames_in, 0U);
  EXPECT_TRUE(outcome.estimate.final);
  EXPECT_TRUE(std::filesystem::exists(folder / "modal.json"));
}

TEST(PipelineTrouble, StopsAtAnyMomentWithACompleteReport) {
  std::mt19937_64 random(20170612);
  for (int i = 0; i < 25; ++i) {
    SCOPED_TRACE("run " + std::to_string(i));
    const auto folder = tests::own_folder();
    CameraScript script = frames(100'000);
    script.lossless = i % 2 == 0;
    script.frame_time = std::chrono::microseconds(i % 3 == 0 ? 0 : 500);
    Rig rig(script, {"spectrum.segment=64", "identification.period=1", "report.directory=" + folder.string()});
    rig.pipeline->start();
    // Half of them within the first frames.
    const auto wait_us = random() % (i % 2 == 0 ? 4000U : 300'000U);
    std::this_thread::sleep_for(std::chrono::microseconds(i == 0 ? 0 : wait_us));
    rig.pipeline->request_stop();
    const auto outcome = rig.finish();
    EXPECT_EQ(outcome.fault, "");
    EXPECT_TRUE(outcome.estimate.final);
    EXPECT_EQ(rig.heard->health.back().state, "finished");
    for (const char* name : {"modal.json", "tracks.csv", "displacements.csv"}) {
      EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
    }
    const std::string displacements = tests::file_text(folder / "displacements.csv");
    const auto n_lines = static_cast<std::uint64_t>(std::count(displacements.begin(), displacements.end(), '\n'));
    EXPECT_GE(n_lines, rig.heard->samples.size());
    if (testing::Test::HasFailure()) break;
  }
}

TEST(PipelineTrouble, MayBeDestroyedAtAnyMomentWithoutJoin) {
  std::mt19937_64 random(7);
  { const Rig never_started(frames(150)); }
  for (int i = 0; i < 12; ++i) {
    CameraScript script = frames(100'000);
    script.lossless = i % 2 == 0;
    Rig rig(script);
    rig.pipeline->start();
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 30'000U));
    rig.pipeline.reset();
    EXPECT_FALSE(rig.heard->health.empty());  // the final status was sent
  }
}

}  // namespace
