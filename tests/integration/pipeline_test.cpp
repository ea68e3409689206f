#include "firmware_app/pipeline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "core/identification/mac.h"
#include "core/simulation/structure_response.h"
#include "tests/support/pipeline_run.h"

namespace {

using tests::CameraScript;
using tests::Heard;
using tests::runs_to_its_end;
using tests::scene_clip;
using ::testing::HasSubstr;

constexpr std::uint64_t kShortClip = 150;
constexpr std::size_t kChannels = 7;  // six floors and the base

struct PublisherMood {
  bool refuses = false;
  std::chrono::microseconds pause{0};
};

app::AppConfig config_of(const tests::SceneClip& clip, const std::vector<std::string>& overrides) {
  return app::parse_config(tests::scene_config(clip.motion), "scene", overrides);
}

// A pipeline over a scripted camera, and what its publisher was told.
struct Rig {
  explicit Rig(const CameraScript& script, const std::vector<std::string>& overrides = {"spectrum.segment=64"},
               std::uint64_t n_drawn = kShortClip, PublisherMood mood = {})
      : clip(scene_clip(n_drawn)), heard(std::make_shared<Heard>()) {
    pipeline = std::make_unique<app::Pipeline>(
        config_of(*clip, overrides), std::make_unique<tests::ScriptedCamera>(clip, script),
        std::make_unique<tests::TellingPublisher>(heard, mood.refuses, mood.pause));
  }

  // Starts, waits for the end, and lets go of the pipeline, so that `heard` is complete.
  app::Pipeline::Outcome run() {
    pipeline->start();
    return finish();
  }
  app::Pipeline::Outcome finish() {
    EXPECT_TRUE(runs_to_its_end(*pipeline)) << "still running: " << pipeline->health().frames_processed << " frames";
    app::Pipeline::Outcome outcome = pipeline->join();
    tests::expect_accounted(outcome.health);
    pipeline.reset();
    for (const core::ModalEstimate& estimate : heard->estimates) tests::expect_finite(estimate);
    EXPECT_EQ(heard->estimates.size(), outcome.health.estimates);
    return outcome;
  }

  std::shared_ptr<const tests::SceneClip> clip;
  std::shared_ptr<Heard> heard;
  std::unique_ptr<app::Pipeline> pipeline;
};

CameraScript frames(std::uint64_t n) {
  CameraScript script;
  script.n_frames = n;
  return script;
}

// Channel samples that the spectrum must have masked, from the samples that were published: all of them, where the
// records ring lost none.
std::uint64_t expected_masked(const Heard& heard) {
  std::uint64_t masked = 0;
  for (std::size_t i = 0; i < heard.samples.size(); ++i) {
    const auto& seen = heard.samples[i].seen;
    for (const std::uint8_t s : seen) masked += s == 0 ? 1U : 0U;
    if (i > 0) masked += (heard.samples[i].sequence - heard.samples[i - 1].sequence - 1) * seen.size();
  }
  return masked;
}

const core::Mode* nearest_mode(const core::ModalEstimate& estimate, double frequency_hz) {
  const core::Mode* best = nullptr;
  for (const core::Mode& mode : estimate.modes) {
    if (best == nullptr || std::abs(mode.frequency_hz - frequency_hz) < std::abs(best->frequency_hz - frequency_hz)) best = &mode;
  }
  return best;
}

TEST(Pipeline, FindsTheModesOfASimulatedBuilding) {
  constexpr double kDurationS = 60.0;
  const std::uint64_t n_frames = 1500;
  Rig rig(frames(n_frames), {}, n_frames);
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.fault, "");
  EXPECT_EQ(outcome.health.state, "finished");
  EXPECT_EQ(outcome.health.frames_processed, n_frames);
  EXPECT_EQ(outcome.estimate.status, "ok");
  const auto& structure = rig.clip->motion.scene().structure;
  const Eigen::MatrixXd shapes = core::simulation::shear_chain_shapes(structure.n_floors());
  for (std::size_t r = 0; r < 3; ++r) {
    const double truth_hz = structure.frequency_hz[r];
    const core::Mode* mode = nearest_mode(outcome.estimate, truth_hz);
    ASSERT_NE(mode, nullptr);
    // Least scatter of a frequency from a random record of this length.
    const double scatter = std::sqrt(structure.damping_ratio[r] / (2.0 * std::numbers::pi * truth_hz * kDurationS));
    EXPECT_NEAR(mode->frequency_hz / truth_hz, 1.0, 3.0 * scatter) << "mode " << r + 1;
    std::vector<std::complex<double>> truth, found;
    for (std::size_t i = 0; i < 6; ++i) {  // the floors stand before the base
      truth.emplace_back(shapes(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(r)), 0.0);
      found.push_back(mode->shape.at(i));
    }
    EXPECT_GT(core::mac(truth, found), 0.97) << "mode " << r + 1;
  }
}

struct PeriodCase {
  int n_frames, segment, period;
  double overlap;
};

class PipelinePeriod : public ::testing::TestWithParam<PeriodCase> {};

// One estimate every `period` hops and one at the end; each says at which sample it was made.
TEST_P(PipelinePeriod, GivesAnEstimateEverySoManyHops) {
  const PeriodCase& p = GetParam();
  CameraScript script = frames(static_cast<std::uint64_t>(p.n_frames));
  Rig rig(script, {"spectrum.segment=" + std::to_string(p.segment), "spectrum.overlap=" + std::to_string(p.overlap),
                   "identification.period=" + std::to_string(p.period)});
  const auto outcome = rig.run();
  const int hop = p.segment - static_cast<int>(p.segment * p.overlap);
  const int n_hops = 1 + (p.n_frames - p.segment) / hop;
  const auto n_periodic = static_cast<std::size_t>(n_hops / p.period);
  ASSERT_EQ(rig.heard->estimates.size(), n_periodic + 1);
  for (std::size_t k = 0; k < rig.heard->estimates.size(); ++k) {
    const core::ModalEstimate& estimate = rig.heard->estimates[k];
    const bool last = k == n_periodic;
    EXPECT_EQ(estimate.number, k);
    EXPECT_EQ(estimate.final, last);
    const int n_samples = last ? p.n_frames : p.segment + hop * (p.period * (static_cast<int>(k) + 1) - 1);
    EXPECT_EQ(estimate.n_samples, static_cast<std::uint64_t>(n_samples));
  }
  EXPECT_EQ(outcome.estimate.number, n_periodic);
}

INSTANTIATE_TEST_SUITE_P(Rules, PipelinePeriod,
                         ::testing::Values(PeriodCase{300, 64, 1, 0.5}, PeriodCase{300, 64, 4, 0.5},
                                           PeriodCase{257, 64, 3, 0.75}, PeriodCase{192, 64, 3, 0.0},
                                           PeriodCase{64, 64, 1, 0.5}, PeriodCase{200, 64, 1000, 0.5}));

TEST(Pipeline, OverloadDropsFramesCountsThemAndMasksTheGaps) {
  CameraScript script = frames(400);
  script.lossless = false;
  script.frame_time = std::chrono::microseconds(100);
  Rig rig(script, {"spectrum.segment=64", "rt.frame_slots=2"});
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.fault, "");
  EXPECT_EQ(outcome.health.frames_in, 400U);
  EXPECT_GT(outcome.health.frames_dropped, 0U);
  EXPECT_EQ(outcome.health.frames_missing, 0U);  // they reached us
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

TEST(Pipeline, ASlowPublisherCostsALiveSourceCountedRecordsAndNothingElse) {
  CameraScript script = frames(200);
  script.lossless = false;
  script.frame_time = std::chrono::milliseconds(5);
  Rig rig(script, {"spectrum.segment=64", "rt.sample_slots=2", "rt.frame_slots=256"}, kShortClip,
          {false, std::chrono::milliseconds(40)});
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.health.frames_processed, 200U);
  EXPECT_LT(rig.heard->samples.size(), 200U);
  EXPECT_EQ(outcome.estimate.n_samples, 200U);
  const core::StageHealth& publish = outcome.health.stages.back();
  EXPECT_EQ(publish.name, "publish");
  EXPECT_EQ(publish.n_dropped, 200U - rig.heard->samples.size());
}

TEST(Pipeline, ASlowPublisherMakesAFileWait) {
  Rig rig(frames(120), {"spectrum.segment=64", "rt.sample_slots=2", "rt.frame_slots=2"}, kShortClip,
          {false, std::chrono::milliseconds(5)});
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.health.frames_processed, 120U);
  EXPECT_EQ(outcome.health.frames_dropped, 0U);
  EXPECT_EQ(rig.heard->samples.size(), 120U);
}

TEST(Pipeline, ACameraFaultFlushesAllThatCameBefore) {
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

TEST(Pipeline, ACameraThatFaultsOnItsFirstFrameIsRefusedAtSetUp) {
  CameraScript script = frames(300);
  script.fault_at = 0;
  try {
    Rig rig(script);
    FAIL() << "accepted";
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), HasSubstr("the cable came off"));
  }
}

TEST(Pipeline, AnEmptyStreamIsRefusedAtSetUp) {
  CameraScript script = frames(0);
  EXPECT_THROW(Rig{script}, std::runtime_error);
}

TEST(Pipeline, SitsOutACameraThatIsSilentForAWhile) {
  CameraScript script = frames(150);
  script.silent_before = 70;
  script.n_timeouts = 40;
  Rig rig(script);
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.fault, "");
  EXPECT_EQ(outcome.health.frames_processed, 150U);
  EXPECT_EQ(outcome.health.frames_missing, 0U);
}

TEST(Pipeline, StopsWhileTheCameraIsSilent) {
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

TEST(Pipeline, MasksWhatTheSourceSkipsAndCountsItAsMissing) {
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

TEST(Pipeline, SurvivesDarknessInTheMiddleAndSeesAgain) {
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

TEST(Pipeline, DarknessToTheEndIsAnEstimateWithoutModesOrNaN) {
  CameraScript script = frames(150);
  script.is_dark = [](std::uint64_t k) { return k >= 1; };
  Rig rig(script);
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.fault, "");
  EXPECT_TRUE(outcome.estimate.modes.empty());
  EXPECT_NE(outcome.estimate.status, "ok");
}

TEST(Pipeline, RefusesRepeatedAndBackwardTimesAndCountsThem) {
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

TEST(Pipeline, SaysHowLongARecordMustBeWhenTheSourceDidNotKnow) {
  CameraScript script = frames(40);
  script.knows_length = false;
  Rig rig(script);
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.fault, "");
  ASSERT_EQ(outcome.notes.size(), 1U);
  EXPECT_THAT(outcome.notes[0], HasSubstr("2.6 s"));  // 64 samples at 25 Hz
  EXPECT_TRUE(outcome.estimate.final);
}

TEST(Pipeline, RefusesARecordShorterThanOneSegment) {
  try {
    Rig rig(frames(63));
    FAIL() << "accepted";
  } catch (const app::ConfigError& e) {
    EXPECT_THAT(e.what(), ::testing::AllOf(HasSubstr("spectrum.segment"), HasSubstr("2.6 s")));
  }
}

TEST(Pipeline, StoppedBeforeItStartsItEndsEmptyAndComplete) {
  const auto folder = tests::own_folder();
  Rig rig(frames(150), {"spectrum.segment=64", "report.directory=" + folder.string()});
  rig.pipeline->request_stop();
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.fault, "");
  EXPECT_EQ(outcome.health.frames_in, 0U);
  EXPECT_TRUE(outcome.estimate.final);
  EXPECT_TRUE(std::filesystem::exists(folder / "modal.json"));
}

TEST(Pipeline, StopsAtAnyMomentWithACompleteReport) {
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

TEST(Pipeline, MayBeDestroyedAtAnyMomentWithoutJoin) {
  std::mt19937_64 random(7);
  { const Rig never_started(frames(150)); }
  for (int i = 0; i < 12; ++i) {
    CameraScript script = frames(100'000);
    script.lossless = i % 2 == 0;
    Rig rig(script);
    rig.pipeline->start();
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 30'000U));
    rig.pipeline.reset();
    EXPECT_FALSE(rig.heard->health.empty());  // the last words were spoken
  }
}

TEST(Pipeline, APublisherThatFailsEverySendIsCountedAndTheRunGoesOn) {
  Rig rig(frames(150), {"spectrum.segment=64"}, kShortClip, {.refuses = true, .pause = {}});
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.fault, "");
  EXPECT_EQ(outcome.health.frames_processed, 150U);
  EXPECT_EQ(outcome.health.messages_sent, 0U);
  const auto& heard = *rig.heard;
  const std::size_t n_calls =
      2 * heard.estimates.size() + heard.samples.size() + heard.tracks.size() + heard.health.size();
  EXPECT_EQ(outcome.health.messages_failed, n_calls);
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

void expect_same_bits(const core::Mode& a, const core::Mode& b) {
  EXPECT_TRUE(same_bits(a.frequency_hz, b.frequency_hz) && same_bits(a.damping_ratio, b.damping_ratio) &&
              same_bits(a.mpc, b.mpc) && same_bits(a.presence, b.presence));
  ASSERT_EQ(a.shape.size(), b.shape.size());
  for (std::size_t i = 0; i < a.shape.size(); ++i) {
    EXPECT_TRUE(same_bits(a.shape[i].real(), b.shape[i].real()) && same_bits(a.shape[i].imag(), b.shape[i].imag()));
  }
  EXPECT_EQ(a.reason, b.reason);
}

TEST(Pipeline, TheSameReplayTwiceGivesTheSameBits) {
  std::vector<std::shared_ptr<Heard>> heard;
  const auto folder = tests::own_folder();
  for (const char* name : {"first", "second"}) {
    Rig rig(frames(400), {"spectrum.segment=64", "identification.period=2", "rt.frame_slots=" + std::to_string(2 + heard.size()),
                          "report.directory=" + (folder / name).string()});
    heard.push_back(rig.heard);
    (void)rig.run();
  }
  const auto& first = heard[0]->estimates;
  const auto& second = heard[1]->estimates;
  ASSERT_EQ(first.size(), second.size());
  std::size_t n_modes = 0;
  for (std::size_t k = 0; k < first.size(); ++k) {
    for (const auto member : {&core::ModalEstimate::modes, &core::ModalEstimate::rejected}) {
      ASSERT_EQ((first[k].*member).size(), (second[k].*member).size());
      for (std::size_t m = 0; m < (first[k].*member).size(); ++m, ++n_modes) {
        expect_same_bits((first[k].*member)[m], (second[k].*member)[m]);
      }
    }
  }
  EXPECT_GT(n_modes, 0U);
  for (const char* name : {"modal.json", "tracks.csv", "displacements.csv"}) {
    const std::string text = tests::file_text(folder / "first" / name);
    EXPECT_FALSE(text.empty()) << name;
    EXPECT_EQ(text == tests::file_text(folder / "second" / name), true) << name;
  }
}

}  // namespace
