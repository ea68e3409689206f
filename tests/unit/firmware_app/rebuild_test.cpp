// A run measured again under a correction.
#include "firmware_app/chain/rebuild.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/simulation/presets.h"
#include "core/simulation/track_generator.h"
#include "firmware_app/chain/makers.h"
#include "firmware_app/replay/track_analysis.h"
#include "tests/support/track_config.h"

namespace app {
namespace {

using core::simulation::TrackGenerator;

struct Flight {
  AppConfig config;
  core::CameraInfo camera;
  std::vector<core::TrackFrame> frames;
};

// The paper's structure for 70 s; a lens is declared that does not exist. delay_s: from a report to its correction.
Flight run_with(double delay_s, double distortion = 0.2) {
  const TrackGenerator tracks(core::simulation::make_paper_scene(1, 70.0));
  Flight out{tests::track_config(tracks,
                                 "spectrum: {segment: 256}\nclosure: {adopt: auto, period_s: 20, window_s: 24, "
                                 "points_per_region: 5, delay_s: " +
                                     std::to_string(delay_s) + "}\n",
                                 distortion),
             tests::track_camera(tracks),
             {}};
  core::TrackFrame frame;
  auto timing = tracks.timing();
  for (core::simulation::DeliveredFrame delivered; timing.next(delivered);) {
    tracks.generate(delivered, frame);
    out.frames.push_back(frame);
  }
  return out;
}

struct Outcome {
  core::ModalEstimate estimate;
  std::vector<std::string> changes;
  CorrectionSet correction;  // the first
};

Outcome outcome_of(const Flight& run) {
  TrackAnalysis analysis(run.config, run.camera, run.frames.front());
  Outcome out;
  analysis.hear_closure([&](const core::closure::ClosureReport& report) {
    out.changes.insert(out.changes.end(), report.changes.begin(), report.changes.end());
  });
  for (core::TrackFrame frame : run.frames) (void)analysis.push(frame);
  out.estimate = analysis.finish();
  out.correction = analysis.corrections().at(1);
  return out;
}

// The correction begins 2 s after the report that decides it.
const Outcome& adopted() {
  static const Outcome outcome = outcome_of(run_with(2.0));
  return outcome;
}

void expect_same_modes(const core::ModalEstimate& a, const core::ModalEstimate& b) {
  EXPECT_EQ(a.n_samples, b.n_samples);
  EXPECT_EQ(a.n_segments, b.n_segments);
  EXPECT_EQ(a.number, b.number);
  ASSERT_EQ(a.modes.size(), b.modes.size());
  for (std::size_t m = 0; m < a.modes.size(); ++m) {
    EXPECT_EQ(a.modes[m].frequency_hz, b.modes[m].frequency_hz);
    EXPECT_EQ(a.modes[m].damping_ratio, b.modes[m].damping_ratio);
    EXPECT_EQ(a.modes[m].shape, b.modes[m].shape);
    ASSERT_TRUE(a.modes[m].history && b.modes[m].history);
    EXPECT_EQ(a.modes[m].history->id, b.modes[m].history->id);
    EXPECT_EQ(a.modes[m].history->n_estimates, b.modes[m].history->n_estimates);
  }
}

// The frames before the correction count as those after it: the frame from which it applies changes no bit.
TEST(Rebuild, TheResultDoesNotDependOnWhenTheCorrectionBegan) {
  const Outcome &early = adopted(), late = outcome_of(run_with(18.0));
  ASSERT_EQ(early.changes.size(), 3U) << "k1, the higher terms of its inverse, and what follows";
  EXPECT_EQ(early.changes[2], "the run is measured again, so from frame 0 on");
  ASSERT_EQ(early.estimate.amendments.size(), 2U);
  ASSERT_GE(early.estimate.modes.size(), 3U);
  EXPECT_EQ(early.estimate.n_samples, 1750U) << "nothing is masked";
  expect_same_modes(early.estimate, late.estimate);
}

struct Again {
  core::ModalEstimate estimate;
  std::uint64_t n_samples = 0, n_masked = 0;
};

// The whole run, measured with the adopted correction from a frame on; before it as declared.
Again measured_again(std::uint64_t from_sequence) {
  const Flight run = run_with(2.0);
  const auto geometry = [&](const CorrectionSet& set) {
    return make_geometry(run.config, run.camera, run.frames.front(), set);
  };
  CorrectionLog book;
  const CorrectionSet& known = book.add(adopted().correction);
  const auto declared = geometry({});
  const auto past = past_of(run.config, run.camera, run.frames.front(), declared->displacement);
  std::vector<Rebuild::Stretch> stretches;
  if (from_sequence > 0) stretches.push_back({0, 0, 0, geometry({})});
  stretches.push_back({from_sequence, known.number, known.record, geometry(known)});
  Rebuild rebuilt(past->chain, book, std::move(stretches));
  const TrackLattice lattice(run.frames.front());
  for (core::TrackFrame frame : run.frames) {
    lattice.round(frame);
    rebuilt.take(frame, 1);
  }
  rebuilt.spectra().finish();
  SpectrumSnapshot last{rebuilt.spectra().sums()};
  rebuilt.spectra().take_snapshot(last);
  IdentificationResult result;
  rebuilt.modes().identify(last, result);
  return {std::move(result.estimate), last.sums.n_samples, rebuilt.spectra().n_masked()};
}

TEST(Rebuild, IsTheRunThatKnewTheCorrectionFromTheStart) {
  expect_same_modes(adopted().estimate, measured_again(0).estimate);
}

// Without the wrong lens nothing is adopted; with it the modes are found as well.
TEST(Rebuild, TheModesAreThoseOfARunWithoutTheError) {
  const Outcome right = outcome_of(run_with(2.0, 0.0));
  const Outcome& corrected = adopted();
  EXPECT_TRUE(right.changes.empty());
  ASSERT_EQ(right.estimate.modes.size(), corrected.estimate.modes.size());
  for (std::size_t m = 0; m < right.estimate.modes.size(); ++m)
    EXPECT_NEAR(corrected.estimate.modes[m].frequency_hz / right.estimate.modes[m].frequency_hz, 1.0, 5e-4);
}

// The correction applies from frame 700 on only: nothing jumps there, and nothing is masked.
TEST(Rebuild, DisplacementsGoOnWhereACorrectionBeginsInTheMiddle) {
  const Again again = measured_again(700);
  EXPECT_EQ(again.n_samples, 1750U);
  EXPECT_EQ(again.n_masked, 0U);
  const core::ModalEstimate& whole = adopted().estimate;
  ASSERT_EQ(again.estimate.modes.size(), whole.modes.size());
  for (std::size_t m = 0; m < whole.modes.size(); ++m) {
    EXPECT_NEAR(again.estimate.modes[m].frequency_hz / whole.modes[m].frequency_hz, 1.0, 1e-2)
        << "the wrong lens was there until then";
  }
}

// --- tracking and the diagnosis agree on a frame --------------------------------------------------------------------

class RebuildHandover : public ::testing::Test {
 protected:
  void take_through(std::uint64_t last) {
    for (; next_ <= last; ++next_) {
      core::TrackFrame frame = run_.frames[next_];
      rebuilt_->take(frame, 1);
      (void)rebuilt_->offer();
    }
  }

  Flight run_ = run_with(2.0);
  CorrectionLog book_;
  std::unique_ptr<Geometry> declared_ = make_geometry(run_.config, run_.camera, run_.frames.front(), {});
  std::unique_ptr<Diagnosis::Past> past_ =
      past_of(run_.config, run_.camera, run_.frames.front(), declared_->displacement);
  std::unique_ptr<Rebuild> rebuilt_ = [this] {
    std::vector<Rebuild::Stretch> stretches;
    stretches.push_back({0, 0, 0, make_geometry(run_.config, run_.camera, run_.frames.front(), {})});
    return std::make_unique<Rebuild>(past_->chain, book_, std::move(stretches));
  }();
  std::size_t next_ = 0;
};

TEST_F(RebuildHandover, BeginsWithTheAnnouncedFrame) {
  take_through(50);
  EXPECT_FALSE(rebuilt_->offered()) << "no frame is announced";
  rebuilt_->announce(60);
  take_through(58);
  EXPECT_FALSE(rebuilt_->offered());
  EXPECT_FALSE(rebuilt_->is_due(59));
  EXPECT_TRUE(rebuilt_->is_due(60));
  EXPECT_FALSE(rebuilt_->begins_with(60)) << "frame 59 is missing";
  take_through(59);
  EXPECT_TRUE(rebuilt_->offered());
  EXPECT_FALSE(rebuilt_->begins_with(59));
  EXPECT_TRUE(rebuilt_->begins_with(60));
  rebuilt_->announce(90);
  EXPECT_TRUE(rebuilt_->begins_with(60)) << "what is offered is not put off";
}

TEST_F(RebuildHandover, FreesItsSpectraOnlyOnceTheyAreTaken) {
  take_through(50);
  rebuilt_->release();
  EXPECT_EQ(rebuilt_->spectra().sums().n_samples, 51U);
  rebuilt_->note_spectra_taken();
  rebuilt_->release();
  rebuilt_->release();
}

TEST_F(RebuildHandover, IsPutOffWhereItIsNotReady) {
  rebuilt_->announce(20);
  take_through(10);
  EXPECT_TRUE(rebuilt_->is_due(20));
  rebuilt_->announce(52);  // a live source goes on
  take_through(50);
  EXPECT_FALSE(rebuilt_->offered());
  take_through(51);
  EXPECT_TRUE(rebuilt_->begins_with(52));
}

TEST_F(RebuildHandover, DoesNotWaitForAFrameThatWasLost) {
  rebuilt_->announce(20);
  take_through(15);  // 16 to 19 never come
  rebuilt_->wait_for(16);
  EXPECT_TRUE(rebuilt_->offer());
  EXPECT_TRUE(rebuilt_->begins_with(20));
}

}  // namespace
}  // namespace app
