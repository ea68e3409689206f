// The whole chain from frames to modes, in this process, with a scripted camera: which modes, how often, how accurate.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <ostream>

#include "core/identification/mac.h"
#include "core/simulation/structure/structure_response.h"
#include "tests/support/pipeline_rig.h"

namespace {

using ::testing::HasSubstr;
using tests::CameraScript;
using tests::frames;
using tests::Heard;
using tests::kShortClip;
using tests::Rig;

const core::Mode* nearest_mode(const core::ModalEstimate& estimate, double frequency_hz) {
  const core::Mode* best = nullptr;
  for (const core::Mode& mode : estimate.modes) {
    if (best == nullptr || std::abs(mode.frequency_hz - frequency_hz) < std::abs(best->frequency_hz - frequency_hz))
      best = &mode;
  }
  return best;
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

TEST(Pipeline, FindsTheModesOfASimulatedBuilding) {
  constexpr double kDurationS = 60.0;
  const std::uint64_t n_frames = 1500;
  Rig rig(frames(n_frames), {}, n_frames);
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.fault, "");
  EXPECT_EQ(outcome.health.state, "finished");
  EXPECT_EQ(outcome.health.frames_processed, n_frames);
  EXPECT_EQ(outcome.estimate.status, "ok");
  const auto modes = core::simulation::modes_of(rig.clip->motion.scene().structure);
  for (std::size_t r = 0; r < 3; ++r) {
    const double truth_hz = modes[r].frequency_hz;
    const core::Mode* mode = nearest_mode(outcome.estimate, truth_hz);
    ASSERT_NE(mode, nullptr);
    // Least possible scatter of a frequency from a random record of this length.
    const double scatter = std::sqrt(modes[r].damping_ratio / (2.0 * std::numbers::pi * truth_hz * kDurationS));
    EXPECT_NEAR(mode->frequency_hz / truth_hz, 1.0, 3.0 * scatter) << "mode " << r + 1;
    std::vector<std::complex<double>> truth, found;
    for (std::size_t i = 0; i < 6; ++i) {  // the floors come before the base
      truth.push_back(modes[r].displacement(static_cast<Eigen::Index>(i)));
      found.push_back(mode->shape.at(i));
    }
    EXPECT_GT(core::mac(truth, found), 0.97) << "mode " << r + 1;
  }
}

TEST(Pipeline, ComparesADeclaredStructureWithItsModes) {
  const std::filesystem::path folder = tests::own_folder();
  const std::string file = (folder / "frame.yaml").string();
  std::ofstream(file) << "structure: {kind: shear_frame, storeys: 6}\n";
  Rig rig(frames(1000), {"closure.structure=" + file, "closure.period_s=20", "closure.window_s=24"});
  const auto heard = rig.heard;
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.fault, "");
  const auto is_of_structure = [](const auto& report) { return report.result.level == "structure"; };
  const auto found = std::find_if(heard->closures.begin(), heard->closures.end(), is_of_structure);
  ASSERT_NE(found, heard->closures.end());
  EXPECT_GT(found->duration_s, 0.0);
  EXPECT_TRUE(std::any_of(outcome.health.stages.begin(), outcome.health.stages.end(),
                          [](const core::StageHealth& stage) { return stage.name == "structure"; }));
}

// Two periods and the remainder; the output does not depend on the time that the stages take.
TEST(Pipeline, ClosesTheLoopWhileItRuns) {
  std::vector<std::shared_ptr<Heard>> heard;
  for (const int slots : {2, 8}) {
    Rig rig(frames(800), {"closure.period_s=20", "closure.window_s=24", "rt.frame_slots=" + std::to_string(slots)});
    heard.push_back(rig.heard);
    EXPECT_EQ(rig.run().fault, "");
  }
  const auto& reports = heard[0]->closures;
  ASSERT_EQ(reports.size(), 2U);
  EXPECT_EQ(reports[0].last_sequence, 499U);
  EXPECT_EQ(reports[1].first_sequence, 200U);
  EXPECT_EQ(reports[1].last_sequence, 799U);
  EXPECT_TRUE(reports[1].final);
  ASSERT_EQ(heard[1]->closures.size(), reports.size());
  for (std::size_t k = 0; k < reports.size(); ++k) {
    EXPECT_EQ(reports[k].refused, "");
    EXPECT_GT(reports[k].result.baseline_rms, 0.0);
    EXPECT_TRUE(same_bits(reports[k].result.baseline_rms, heard[1]->closures[k].result.baseline_rms));
    EXPECT_TRUE(same_bits(reports[k].result.residual_rms, heard[1]->closures[k].result.residual_rms));
  }
}

// A lens is declared that does not exist. Two reports agree on it; from the announced frame on it is corrected, and the
// estimates state it. The frames before are measured again. Neither frame nor bits depend on the stages' timing.
TEST(Pipeline, TakesOutWhatTwoReportsFoundFromTheAnnouncedFrameOn) {
  std::vector<std::shared_ptr<Heard>> heard;
  for (const int slots : {2, 64}) {
    Rig rig(frames(1500), {"closure.adopt=auto", "closure.period_s=20", "closure.window_s=24", "closure.delay_s=4",
                           "calibration.distortion=[0.2, 0, 0, 0]", "spectrum.segment=64",
                           "closure.points_per_region=5", "rt.frame_slots=" + std::to_string(slots)});
    heard.push_back(rig.heard);
    EXPECT_EQ(rig.run().fault, "");
  }
  const auto& reports = heard[0]->closures;
  ASSERT_EQ(reports.size(), 3U);
  EXPECT_TRUE(reports[0].changes.empty());
  ASSERT_EQ(reports[1].changes.size(), 2U);
  EXPECT_EQ(reports[1].changes[1], "the run is measured again, so from frame 0 on");
  EXPECT_THAT(reports[1].changes[0], HasSubstr("from frame 1100 on taken out, radial distortion"));
  EXPECT_EQ(reports[2].in_force.size(), 1U);
  const auto& estimates = heard[0]->estimates;
  ASSERT_FALSE(estimates.empty());
  EXPECT_TRUE(estimates.front().amendments.empty());
  EXPECT_EQ(estimates.back().amendments.size(), 1U);
  EXPECT_EQ(estimates.back().n_samples, 1500U) << "nothing is masked";
  ASSERT_EQ(heard[1]->estimates.size(), estimates.size());
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    EXPECT_EQ(estimates[k].amendments, heard[1]->estimates[k].amendments);
    ASSERT_EQ(estimates[k].modes.size(), heard[1]->estimates[k].modes.size());
    for (std::size_t m = 0; m < estimates[k].modes.size(); ++m)
      EXPECT_TRUE(same_bits(estimates[k].modes[m].frequency_hz, heard[1]->estimates[k].modes[m].frequency_hz));
  }
}

TEST(Pipeline, LooksForNoMissingEffectWhereNobodyWantsIt) {
  Rig rig(frames(100), {"closure.adopt=off", "spectrum.segment=64"});
  const auto outcome = rig.run();
  EXPECT_TRUE(rig.heard->closures.empty());
  for (const core::StageHealth& stage : outcome.health.stages) EXPECT_NE(stage.name, "closure");
}

struct PeriodCase {
  int n_frames, segment, period;
  double overlap;
};

std::ostream& operator<<(std::ostream& out, const PeriodCase& c) {
  return out << c.n_frames << " frames, segment " << c.segment << ", period " << c.period << ", overlap " << c.overlap;
}

class PipelinePeriod : public ::testing::TestWithParam<PeriodCase> {};

// Hops after which there is an estimate: 1, 2, 4 ... until the period is reached, then every `period` of them.
std::vector<int> hops_with_estimate(int n_hops, int period) {
  std::vector<int> out;
  for (int hop = 1; hop < period && hop <= n_hops; hop *= 2) out.push_back(hop);
  for (int hop = period; hop <= n_hops; hop += period) out.push_back(hop);
  return out;
}

// These and one at the end; each states the sample at which it was made.
TEST_P(PipelinePeriod, GivesAnEstimateEverySoManyHops) {
  const PeriodCase& p = GetParam();
  CameraScript script = frames(static_cast<std::uint64_t>(p.n_frames));
  Rig rig(script, {"spectrum.segment=" + std::to_string(p.segment), "spectrum.overlap=" + std::to_string(p.overlap),
                   "identification.period=" + std::to_string(p.period)});
  const auto outcome = rig.run();
  const int hop = p.segment - static_cast<int>(p.segment * p.overlap);
  const std::vector<int> hops = hops_with_estimate(1 + (p.n_frames - p.segment) / hop, p.period);
  ASSERT_EQ(rig.heard->estimates.size(), hops.size() + 1);
  for (std::size_t k = 0; k < rig.heard->estimates.size(); ++k) {
    const core::ModalEstimate& estimate = rig.heard->estimates[k];
    const bool last = k == hops.size();
    EXPECT_EQ(estimate.number, k);
    EXPECT_EQ(estimate.final, last);
    const int n_samples = last ? p.n_frames : p.segment + hop * (hops[k] - 1);
    EXPECT_EQ(estimate.n_samples, static_cast<std::uint64_t>(n_samples));
  }
  EXPECT_EQ(outcome.estimate.number, hops.size());
}

INSTANTIATE_TEST_SUITE_P(Rules, PipelinePeriod,
                         ::testing::Values(PeriodCase{300, 64, 1, 0.5}, PeriodCase{300, 64, 4, 0.5},
                                           PeriodCase{257, 64, 3, 0.75}, PeriodCase{192, 64, 3, 0.0},
                                           PeriodCase{64, 64, 1, 0.5}, PeriodCase{200, 64, 1000, 0.5}));

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

TEST(Pipeline, APublisherThatFailsEverySendIsCountedAndTheRunGoesOn) {
  Rig rig(frames(150), {"spectrum.segment=64"}, kShortClip, {.refuses = true, .pause = {}});
  const auto outcome = rig.run();
  EXPECT_EQ(outcome.fault, "");
  EXPECT_EQ(outcome.health.frames_processed, 150U);
  EXPECT_EQ(outcome.health.messages_sent, 0U);
  const auto& heard = *rig.heard;
  const std::size_t n_calls = 2 * heard.estimates.size() + heard.samples.size() + heard.tracks.size() +
                              heard.closures.size() + heard.health.size();
  EXPECT_EQ(outcome.health.messages_failed, n_calls);
}

void expect_same_bits(const core::Mode& a, const core::Mode& b) {
  EXPECT_TRUE(same_bits(a.frequency_hz, b.frequency_hz) && same_bits(a.damping_ratio, b.damping_ratio) &&
              same_bits(a.mpc, b.mpc) && same_bits(a.presence, b.presence));
  ASSERT_EQ(a.shape.size(), b.shape.size());
  for (std::size_t i = 0; i < a.shape.size(); ++i) {
    EXPECT_TRUE(same_bits(a.shape[i].real(), b.shape[i].real()) && same_bits(a.shape[i].imag(), b.shape[i].imag()));
  }
  EXPECT_EQ(a.reason, b.reason);
  ASSERT_EQ(a.history.has_value(), b.history.has_value());
  if (!a.history) return;
  EXPECT_EQ(a.history->id, b.history->id);
  EXPECT_EQ(a.history->n_estimates, b.history->n_estimates);
  EXPECT_TRUE(same_bits(a.history->drift_hz_per_s.value_or(0.0), b.history->drift_hz_per_s.value_or(0.0)) &&
              same_bits(a.history->more_s.value_or(0.0), b.history->more_s.value_or(0.0)));
}

TEST(Pipeline, TheSameReplayTwiceGivesTheSameBits) {
  std::vector<std::shared_ptr<Heard>> heard;
  const auto folder = tests::own_folder();
  for (const char* name : {"first", "second"}) {
    Rig rig(frames(1200),  // as many as a verdict needs
            {"spectrum.segment=64", "identification.period=2", "rt.frame_slots=" + std::to_string(2 + heard.size()),
             "report.directory=" + (folder / name).string()});
    heard.push_back(rig.heard);
    (void)rig.run();
  }
  const auto& first = heard[0]->estimates;
  const auto& second = heard[1]->estimates;
  ASSERT_EQ(first.size(), second.size());
  std::size_t n_modes = 0, n_followed = 0;
  for (std::size_t k = 0; k < first.size(); ++k) {
    for (const auto member : {&core::ModalEstimate::modes, &core::ModalEstimate::rejected}) {
      ASSERT_EQ((first[k].*member).size(), (second[k].*member).size());
      for (std::size_t m = 0; m < (first[k].*member).size(); ++m, ++n_modes) {
        expect_same_bits((first[k].*member)[m], (second[k].*member)[m]);
        n_followed += (first[k].*member)[m].history ? 1U : 0U;
      }
    }
  }
  EXPECT_GT(n_modes, 0U);
  EXPECT_GT(n_followed, 0U);
  for (const char* name : {"modal.json", "tracks.csv", "displacements.csv"}) {
    const std::string text = tests::file_text(folder / "first" / name);
    EXPECT_FALSE(text.empty()) << name;
    EXPECT_EQ(text == tests::file_text(folder / "second" / name), true) << name;
  }
}

}  // namespace
