#include "core/identification/mode_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/simulation/random_stream.h"

namespace core {
namespace {

using Shape = std::vector<std::complex<double>>;
constexpr double kRateHz = 25.0;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Shape kFirst{0.3, 0.6, 1.0}, kSecond{-0.8, -0.5, 1.0}, kThird{1.0, -0.9, 0.4};

Mode mode_at(double frequency_hz, const Shape& shape, Verdict verdict = Verdict::kStructural) {
  Mode mode;
  mode.frequency_hz = mode.apparent_hz = frequency_hz;
  mode.damping_ratio = 0.01;
  mode.shape = shape;
  mode.verdict = verdict;
  return mode;
}

// Observation of a mode at n times the rate from the apparent one, as identified with this alias order.
Mode folded_mode(double apparent_hz, int fold_n, const Shape& shape) {
  Mode mode = mode_at(std::abs(apparent_hz + fold_n * kRateHz), shape);
  mode.apparent_hz = apparent_hz;
  mode.fold_n = fold_n;
  mode.fold_margin = 0.5;
  return mode;
}

// Successive estimates of one record, 20 s apart.
class ModeTrackerTest : public ::testing::Test {
 protected:
  ModalEstimate next(std::vector<Mode> modes, std::vector<Mode> rejected = {}) {
    ModalEstimate estimate;
    estimate.number = n_++;
    estimate.rate_hz = kRateHz;
    estimate.duration_s = 60.0 + 20.0 * static_cast<double>(estimate.number);
    estimate.n_samples = static_cast<std::uint64_t>(estimate.duration_s * kRateHz);
    estimate.status = "ok";
    estimate.modes = std::move(modes);
    estimate.rejected = std::move(rejected);
    tracker_.update(estimate);
    return estimate;
  }
  static std::uint32_t id(const Mode& mode) { return mode.history ? mode.history->id : 0; }

  ModeTracker tracker_{{.row_delay_s = {0.0, 0.0, 0.0}}};
  std::uint64_t n_ = 0;
};

TEST_F(ModeTrackerTest, NumbersAModeWhenASecondEstimateFindsIt) {
  EXPECT_EQ(id(next({mode_at(2.0, kFirst), mode_at(5.0, kSecond)}).modes[0]), 0U);
  const auto second = next({mode_at(2.01, kFirst), mode_at(5.01, kSecond), mode_at(8.0, kThird)});
  EXPECT_EQ(id(second.modes[0]), 1U);
  EXPECT_EQ(id(second.modes[1]), 2U);
  EXPECT_EQ(id(second.modes[2]), 0U);
  const auto third = next({mode_at(2.0, kFirst), mode_at(5.0, kSecond), mode_at(8.01, kThird)});
  EXPECT_EQ(id(third.modes[2]), 3U);
  EXPECT_EQ(third.modes[0].history->n_estimates, 3U);
  EXPECT_EQ(third.modes[2].history->n_estimates, 2U);
  EXPECT_EQ(third.modes[2].history->first_number, 1U);
  EXPECT_DOUBLE_EQ(third.modes[2].history->first_seen_s, 80.0);
  EXPECT_EQ(tracker_.n_followed(), 3U);
}

TEST_F(ModeTrackerTest, GivesNoNumberToWhatComesAndGoes) {
  for (int k = 0; k < 6; ++k) {
    const auto estimate = k % 2 == 0 ? next({mode_at(3.0, kFirst)}) : next({});
    for (const Mode& mode : estimate.modes) EXPECT_EQ(id(mode), 0U);
  }
}

TEST_F(ModeTrackerTest, TellsTwoCrossingModesApartByTheirShapes) {
  for (int k = 0; k < 13; ++k) {
    const double shift = 0.01 * (k - 6);
    std::vector<Mode> modes{mode_at(5.0 + shift, kFirst), mode_at(5.0 - shift, kSecond)};
    if (shift > 0.0) std::swap(modes[0], modes[1]);  // by frequency, as the identification lists them
    const auto estimate = next(std::move(modes));
    if (k == 0) continue;
    for (const Mode& mode : estimate.modes) EXPECT_EQ(id(mode), mode.shape == kFirst ? 1U : 2U) << k;
  }
}

TEST_F(ModeTrackerTest, KeepsTwinsOfOneShapeInTheirOrder) {
  // Both move together: the cheapest single pair would be the upper old with the lower new one.
  for (int k = 0; k < 8; ++k) {
    const double shift = 0.03 * k;
    const auto estimate = next({mode_at(5.0 + shift, kFirst), mode_at(5.06 + shift, kFirst)});
    if (k == 0) continue;
    EXPECT_EQ(id(estimate.modes[0]), 1U) << k;
    EXPECT_EQ(id(estimate.modes[1]), 2U) << k;
  }
}

TEST_F(ModeTrackerTest, GivesAModeThatReturnsItsNumberBack) {
  for (int k = 0; k < 3; ++k) next({mode_at(2.0, kFirst), mode_at(5.0, kSecond)});
  for (int k = 0; k < 10; ++k) EXPECT_EQ(id(next({mode_at(2.0, kFirst)}).modes[0]), 1U);
  EXPECT_EQ(tracker_.n_followed(), 1U);  // the other is lost by now
  const auto back = next({mode_at(2.0, kFirst), mode_at(5.01, kSecond)});
  EXPECT_EQ(id(back.modes[1]), 2U);
  EXPECT_EQ(back.modes[1].history->n_estimates, 4U);
  EXPECT_EQ(back.modes[1].history->first_number, 0U);
  EXPECT_EQ(tracker_.n_followed(), 2U);
}

TEST_F(ModeTrackerTest, ForgetsAModeThatStaysAway) {
  for (int k = 0; k < 3; ++k) next({mode_at(2.0, kFirst), mode_at(5.0, kSecond)});
  for (int k = 0; k < 95; ++k) next({mode_at(2.0, kFirst)});  // 1900 s
  next({mode_at(2.0, kFirst), mode_at(5.0, kSecond)});
  EXPECT_EQ(id(next({mode_at(2.0, kFirst), mode_at(5.0, kSecond)}).modes[1]), 3U);
}

TEST_F(ModeTrackerTest, DoesNotTakeAnotherShapeForAModeThatWasLost) {
  for (int k = 0; k < 3; ++k) next({mode_at(5.0, kFirst)});
  for (int k = 0; k < 4; ++k) next({});
  next({mode_at(5.0, kSecond)});
  EXPECT_EQ(id(next({mode_at(5.0, kSecond)}).modes[0]), 2U);
}

TEST_F(ModeTrackerTest, AFailedEstimateEndsNoMode) {
  for (int k = 0; k < 2; ++k) next({mode_at(5.0, kFirst)});
  for (int k = 0; k < 9; ++k) {
    ModalEstimate failed;
    failed.status = "record too short";
    tracker_.update(failed);
  }
  EXPECT_EQ(tracker_.n_followed(), 1U);
  for (int k = 0; k < 3; ++k) next({});  // these estimates do not contain it
  EXPECT_EQ(tracker_.n_followed(), 0U);
}

TEST_F(ModeTrackerTest, AnAmbiguousPoleContinuesAModeAndBeginsNone) {
  for (int k = 0; k < 2; ++k) next({mode_at(5.0, kFirst)});
  const auto open = next({}, {mode_at(3.0, kThird, Verdict::kAmbiguous), mode_at(5.0, kFirst, Verdict::kAmbiguous),
                              mode_at(5.0, kFirst, Verdict::kNumerical)});
  EXPECT_EQ(id(open.rejected[0]), 0U);
  EXPECT_EQ(id(open.rejected[1]), 1U);
  EXPECT_EQ(id(open.rejected[2]), 0U);
  EXPECT_EQ(id(next({}, {mode_at(3.0, kThird, Verdict::kAmbiguous)}).rejected[0]), 0U);
}

TEST_F(ModeTrackerTest, KeepsTheNumberWhenAnotherFoldIsRead) {
  const std::vector<double> delay_s{0.0, 0.012, 0.024};
  tracker_ = ModeTracker({.row_delay_s = delay_s});
  // 12.93 Hz at 25 fps: appears at 12.07, mirrored. Interpreted as 12.07 the same data give another, complex shape.
  Shape other(3);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto turn = [&](double hz) { return std::polar(1.0, 2.0 * std::numbers::pi * hz * delay_s[c]); };
    other[c] = std::conj(kThird[c] * turn(12.93)) / turn(12.07);
  }
  for (int k = 0; k < 5; ++k) next({folded_mode(12.07, -1, kThird)});
  const auto direct = next({folded_mode(12.07, 0, other)});
  EXPECT_EQ(id(direct.modes[0]), 1U);
  EXPECT_EQ(direct.modes[0].history->n_fold_changes, 1U);
  EXPECT_FALSE(direct.modes[0].history->drift_hz_per_s) << "12.93 and 12.07 Hz are no trend";
  EXPECT_EQ(next({folded_mode(12.07, -1, kThird)}).modes[0].history->n_fold_changes, 2U);
}

TEST_F(ModeTrackerTest, TellsADriftFromTheScatterOfSharedData) {
  constexpr int kSeeds = 100;
  int n_false = 0, n_found = 0;
  for (const bool drifts : {false, true}) {
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      simulation::RandomStream random(seed, "drift");
      tracker_ = ModeTracker({.row_delay_s = {0.0, 0.0, 0.0}});
      n_ = 0;
      double integral = 0.0, before_s = 0.0;
      bool flagged = false;
      for (int k = 0; k < 40; ++k) {  // 840 s; 2 % of drift, or none: 7.8 sigma in theory
        const double now_s = 60.0 + 20.0 * k, piece_s = now_s - before_s;
        const double rate = drifts ? 0.1 / 840.0 : 0.0;
        integral += (5.0 + rate * 0.5 * (now_s + before_s)) * piece_s;
        integral += 1.2 * std::sqrt(0.01 * 5.0 / (2.0 * std::numbers::pi) * piece_s) * random.gaussian();
        before_s = now_s;
        const auto estimate = next({mode_at(integral / now_s, kFirst)});
        if (k > 0) {
          ASSERT_EQ(id(estimate.modes[0]), 1U);
          flagged = flagged || estimate.modes[0].history->drifts;
        }
      }
      (drifts ? n_found : n_false) += flagged ? 1 : 0;
    }
  }
  EXPECT_LE(n_false, 1);
  EXPECT_GE(n_found, 98);
}

TEST_F(ModeTrackerTest, UsesTheStatedStandardDeviation) {
  const auto stated = [](double frequency_hz) {
    Mode mode = mode_at(frequency_hz, kFirst);
    mode.frequency_std_hz = 0.1;
    mode.damping_std = 0.002;
    return mode;
  };
  next({stated(5.0)});
  const auto estimate = next({stated(5.4)});  // far beyond what theory allows at 1 % damping
  ASSERT_EQ(id(estimate.modes[0]), 1U);
  EXPECT_NEAR(*estimate.modes[0].history->more_s, 80.0 * 4.0 - 80.0, 1e-9);  // 20 % now; scatter falls as 1/sqrt(T)
  ModeTracker other({.row_delay_s = {0.0, 0.0, 0.0}});
  std::swap(tracker_, other);
  next({mode_at(5.0, kFirst)});
  EXPECT_EQ(id(next({mode_at(5.4, kFirst)}).modes[0]), 0U);
}

TEST_F(ModeTrackerTest, TellsHowMuchMoreRecordTheDampingWants) {
  next({mode_at(1.0, kFirst)});
  const auto slow = next({mode_at(1.0, kFirst)});
  // 1.2^2 / (2 pi 0.01 1 Hz 0.1^2) = 2291.8 s in all
  EXPECT_NEAR(*slow.modes[0].history->more_s, 2291.8 - 80.0, 0.1);
  tracker_ = ModeTracker({.row_delay_s = {0.0, 0.0, 0.0}});
  next({mode_at(40.0, kFirst)});
  EXPECT_EQ(*next({mode_at(40.0, kFirst)}).modes[0].history->more_s, 0.0);
}

TEST_F(ModeTrackerTest, LeavesOutWhatIsNoNumber) {
  for (int k = 0; k < 4; ++k) {
    Mode no_frequency = mode_at(kNan, kFirst), no_damping = mode_at(3.0, kFirst), no_shape = mode_at(4.0, {});
    no_damping.damping_ratio = kNan;
    const auto estimate = next({no_frequency, no_damping, no_shape, mode_at(6.0, {kNan, 1.0, 1.0}),
                                mode_at(7.0, {1.0, 1.0}), mode_at(8.0, {0.0, 0.0, 0.0}), mode_at(5.0, kFirst)});
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(id(estimate.modes[i]), 0U) << i;
    EXPECT_EQ(id(estimate.modes[6]), k == 0 ? 0U : 1U);
  }
  ModalEstimate endless;
  endless.status = "ok";
  endless.duration_s = kNan;
  endless.modes = {mode_at(5.0, kFirst)};
  tracker_.update(endless);
  EXPECT_FALSE(endless.modes[0].history);
}

TEST_F(ModeTrackerTest, CountsWhatFindsNoRoom) {
  std::vector<Mode> many;
  for (int i = 0; i < 70; ++i) many.push_back(mode_at(1.0 + i, kFirst));
  next(many);
  const auto estimate = next(many);
  EXPECT_EQ(tracker_.n_followed(), ModeTracker::kMaxTracks);
  EXPECT_EQ(tracker_.n_left_out(), 12U);
  EXPECT_EQ(id(estimate.modes[63]), 64U);
  EXPECT_EQ(id(estimate.modes[64]), 0U);
}

TEST_F(ModeTrackerTest, ARecordThatStartsAnewKeepsTheNumbersAndForgetsTheTrend) {
  for (int k = 0; k < 6; ++k) next({mode_at(5.0, kFirst)});
  n_ = 0;
  const auto estimate = next({mode_at(5.0, kFirst)});
  EXPECT_EQ(id(estimate.modes[0]), 1U);
  EXPECT_FALSE(estimate.modes[0].history->drift_hz_per_s);
}

}  // namespace
}  // namespace core
