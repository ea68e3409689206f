#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/observation_fit.h"
#include "core/closure/observation/observation_report.h"
#include "core/closure/observation/observation_scores.h"
#include "core/closure/observation/region_modes.h"
#include "core/closure/observation/remainder.h"
#include "core/closure/observation/stacked_positions.h"
#include "tests/support/swaying_record.h"

namespace core::closure {
namespace {

using test_support::kPi;
using test_support::swaying_record;
using ::testing::Contains;
using ::testing::Not;

std::vector<const ObservationEffect*> catalogue_of(const std::vector<std::string>& keys) {
  std::vector<const ObservationEffect*> out;
  for (const std::string& key : keys) out.push_back(observation_effect({key}));
  return out;
}

std::size_t place_of(const std::vector<CandidateScore>& scores, const std::string& key) {
  const auto found = std::find_if(scores.begin(), scores.end(), [&](const auto& s) { return s.id.key == key; });
  return static_cast<std::size_t>(found - scores.begin());
}

// Solves the fit, adopts the first candidate and solves again.
void solve_with_first(ObservationFit& fit, ObservationScores& scores) {
  fit.solve();
  scores.begin();
  fit.add(scores.adopted(0));
  fit.solve();
}

TEST(StackedPositions, GapsAreStraightLinesAndListed) {
  ObservationRecord record = swaying_record(600, {});
  const double before = record.u_px(9, 5), after = record.u_px(12, 5);
  record.u_px(10, 5) = record.u_px(11, 5) = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::pair<Eigen::Index, Eigen::Index>> missing;
  const Eigen::MatrixXd stacked = stacked_positions(record, missing);
  EXPECT_EQ(missing.size(), 4U);  // both axes
  EXPECT_NEAR(stacked(10, 10), before + (after - before) / 3.0, 1e-9);
  EXPECT_FALSE(stacked.hasNaN());
}

TEST(ObservationFit, AdoptedConstantsAreFittedAndCopiesKeepTheirs) {
  ObservationFit fit(swaying_record(1000, {.k1 = -0.2}));
  const auto catalogue = catalogue_of({"radial_distortion"});
  ObservationScores scores(fit, catalogue);
  fit.solve();
  scores.begin();
  fit.add(scores.adopted(0));
  ObservationFit::Effects unfitted = fit.copy_effects();
  fit.solve();
  EXPECT_NEAR(effect_parameters(fit, 0).at(0).value, -0.2, 0.005);
  fit.set_effects(std::move(unfitted));
  EXPECT_EQ(effect_parameters(fit, 0).at(0).value, 0.0);
  fit.remove(0);
  EXPECT_TRUE(fit.effects().empty());
}

TEST(ObservationFit, AmplitudeIsTheInjectedRotation) {
  ObservationFit fit(swaying_record(1000, {.roll_rms_rad = 0.03 * kPi / 180.0}));
  const auto catalogue = catalogue_of({"camera_roll"});
  ObservationScores scores(fit, catalogue);
  solve_with_first(fit, scores);
  const Eigen::RowVectorXd amplitude = fit.amplitude(0);
  Eigen::RowVectorXd truth(1000);
  for (Eigen::Index k = 0; k < 1000; ++k) truth(k) = std::sin(2.0 * kPi * 0.23 * static_cast<double>(k) / 25.0 + 1.0);
  EXPECT_GT(std::abs(amplitude.dot(truth)), 0.98 * amplitude.norm() * truth.norm());
}

// A bend of the image with an amplitude of its own, in a record where the camera's roll is adopted.
std::optional<Remainder> remainder_of_bend(double bend_px, double frequency_hz) {
  ObservationRecord record = swaying_record(1500, {.roll_rms_rad = 0.1 * kPi / 180.0});
  Eigen::VectorXd bend = Eigen::VectorXd::Zero(2 * record.n_points());
  for (Eigen::Index j = 0; j < record.n_points(); ++j) {
    bend(2 * j + 1) = j % 2 == 0 ? 1.0 : -1.0;
    for (Eigen::Index k = 0; k < record.n_frames(); ++k) {
      const double t = static_cast<double>(k) / record.rate_hz;
      record.v_px(k, j) += bend_px * bend(2 * j + 1) * std::sin(2.0 * kPi * frequency_hz * t + 0.4);
    }
  }
  ObservationFit fit(record);
  const auto catalogue = catalogue_of({"camera_roll"});
  ObservationScores scores(fit, catalogue);
  solve_with_first(fit, scores);
  const ResidualMoments residual = residual_moments(fit.model().residual(), record.rate_hz);
  return Remainders(fit, residual).find(bend, kAllRungs);
}

TEST(Remainder, IsSmallAndAtTheFrequenciesOfAnAdoptedEffect) {
  const auto small = remainder_of_bend(0.02, 0.23);
  ASSERT_TRUE(small);
  EXPECT_EQ(small->effect, "camera roll");
  EXPECT_LT(small->share, 0.05);
  EXPECT_FALSE(remainder_of_bend(0.02, 5.1)) << "at another frequency";
  EXPECT_FALSE(remainder_of_bend(0.12, 0.23)) << "as large as an effect of its own";
}

TEST(ObservationScores, TheInjectedEffectLeadsAndSurrogatesAreRepeatable) {
  ObservationFit fit(swaying_record(1000, {.locking_px = 0.05}));
  const auto catalogue = catalogue_of({"camera_roll", "radial_distortion", "pixel_locking"});
  ObservationScores scores(fit, catalogue);
  fit.solve();
  scores.begin();
  const std::vector<CandidateScore> found = scores.score();
  ASSERT_EQ(found.size(), 4U);  // and a latent pattern
  const std::size_t locking = place_of(found, "pixel_locking");
  ASSERT_LT(locking, found.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_LE(found[i].score, found[locking].score) << found[i].effect;
  EXPECT_TRUE(found[locking].refusal.empty()) << found[locking].refusal;
  EXPECT_EQ(found.back().kind, EffectKind::kLatent);
  const double chance = scores.surrogate_score(3);
  EXPECT_EQ(chance, scores.surrogate_score(3));
  EXPECT_NE(chance, scores.surrogate_score(4));
  EXPECT_LT(chance, found[locking].score);
  EXPECT_THROW((void)scores.adopted(4), std::invalid_argument);
}

TEST(ObservationScores, AnAdoptedEffectIsNoCandidate) {
  ObservationFit fit(swaying_record(1000, {.locking_px = 0.05}));
  const auto catalogue = catalogue_of({"camera_roll", "pixel_locking"});
  ObservationScores scores(fit, catalogue);
  fit.solve();
  scores.begin();
  EXPECT_THAT(scores.candidates(), Contains("pixel locking"));
  fit.add(scores.adopted(1));
  fit.solve();
  scores.begin();
  EXPECT_THAT(scores.candidates(), Not(Contains("pixel locking")));
  EXPECT_NEAR(scores.quality().heldout, scores.quality().noise_floor, 0.05 * scores.quality().noise_floor);
}

TEST(ObservationReport, WithoutReadoutALinesTrueFrequencyIsNotObservable) {
  ObservationRecord record = swaying_record(1000, {});
  const auto catalogue = catalogue_of({"rotor_line"});
  const auto names = [&] {
    ObservationFit fit(record);
    fit.solve();
    std::vector<std::string> out;
    for (const NotObservable& one : not_observable(fit, catalogue)) out.push_back(one.effect);
    return out;
  };
  EXPECT_THAT(names(), Contains("true frequency of a rotor line"));
  record.readout_frames = 0.5;
  EXPECT_THAT(names(), Not(Contains("true frequency of a rotor line")));
}

TEST(ComparedModes, AReferenceFindsTheNearestWithinFivePercent) {
  std::vector<core::Mode> found(2), reference(2);
  found[0].frequency_hz = 1.03, found[1].frequency_hz = 4.0;
  reference[0].frequency_hz = 1.0, reference[1].frequency_hz = 9.0;
  const std::vector<ClosureMode> modes = compared_modes(found, reference);
  ASSERT_EQ(modes.size(), 2U);
  EXPECT_EQ(modes[0].frequency_hz, 1.03);
  EXPECT_NEAR(modes[0].error_percent.value_or(0.0), 3.0, 1e-9);
  EXPECT_EQ(modes[1].frequency_hz, 0.0);
  EXPECT_FALSE(modes[1].error_percent);
  EXPECT_NEAR(rms_error_percent(modes).value_or(0.0), 3.0, 1e-9);
  EXPECT_FALSE(rms_error_percent({}));
}

}  // namespace
}  // namespace core::closure
