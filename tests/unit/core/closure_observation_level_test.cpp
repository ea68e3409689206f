#include <gtest/gtest.h>

#include <Eigen/QR>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/closure/closure_loop.h"
#include "core/closure/noise_stream.h"
#include "core/closure/observation/leave_one_point_out.h"
#include "core/closure/observation/observation_level.h"
#include "core/closure/observation/point_screening.h"
#include "tests/support/swaying_record.h"

namespace core::closure {
namespace {

using test_support::kPi;
using test_support::swaying_record;

ClosureResult closed(const ObservationRecord& record) {
  ObservationLevel level(record);
  ClosureOptions options;
  options.n_surrogates = 8;
  return close_loop(level, options);
}

std::string words(const ClosureResult& result) {
  std::string text = result.stop_reason;
  for (const CandidateScore& s : result.refused)
    text += "; " + s.effect + " " + std::to_string(s.score) + " " + s.refusal;
  for (const ClosureStep& s : result.steps) text += "; adopted " + s.effect;
  return text;
}

std::string fault(const ObservationRecord& record) {
  try {
    const ObservationLevel level(record);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return {};
}

TEST(LeaveOnePointOut, ClosedFormIsTheFitWithoutThePoint) {
  Eigen::MatrixXd x(12, 3);
  NoiseStream noise(3);
  for (double& value : x.reshaped()) value = noise.gaussian();
  Eigen::VectorXd z(12);
  for (double& value : z) value = noise.gaussian();
  const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(x).householderQ() * Eigen::MatrixXd::Identity(12, 3);
  double direct = 0.0;
  for (Eigen::Index j = 0; j < 6; ++j) {
    Eigen::MatrixXd rest = x;
    Eigen::VectorXd rest_z = z;
    rest.middleRows(2 * j, 2).setZero();
    rest_z.segment(2 * j, 2).setZero();
    const Eigen::VectorXd a = rest.colPivHouseholderQr().solve(rest_z);
    direct += (z.segment(2 * j, 2) - x.middleRows(2 * j, 2) * a).squaredNorm();
  }
  const Eigen::VectorXd r = z - q * (q.transpose() * z);
  EXPECT_NEAR(LeaveOnePointOut(q).squares(r * r.transpose()), direct, 1e-9);
}

TEST(ObservationLevel, RollIsNamedAndItsSizeFound) {
  const double truth_deg = 0.03;
  const ClosureResult result = closed(swaying_record(1000, {.roll_rms_rad = truth_deg * kPi / 180.0}));
  ASSERT_EQ(result.steps.size(), 1U) << words(result);
  EXPECT_EQ(result.steps[0].effect, "camera roll");
  ASSERT_FALSE(result.steps[0].parameters.empty());
  EXPECT_NEAR(result.steps[0].parameters[0].value, truth_deg, 0.002);
  EXPECT_LT(result.steps[0].heldout_after, 1.05 * result.noise_floor);
}

TEST(ObservationLevel, RadialDistortionIsNamedWithItsCoefficient) {
  const ClosureResult result = closed(swaying_record(1000, {.k1 = -0.2}));
  ASSERT_EQ(result.steps.size(), 1U) << words(result);
  EXPECT_EQ(result.steps[0].effect, "radial distortion");
  const ParameterValue& k1 = result.steps[0].parameters.at(0);
  EXPECT_NEAR(k1.value, -0.2, 4.0 * k1.sigma.value_or(0.0));
  EXPECT_LT(result.steps[0].heldout_after, 1.05 * result.noise_floor);
}

TEST(ObservationLevel, PixelLockingIsNamedWithItsAmplitude) {
  const ClosureResult result = closed(swaying_record(1000, {.locking_px = 0.05}));
  ASSERT_EQ(result.steps.size(), 1U) << words(result);
  EXPECT_EQ(result.steps[0].effect, "pixel locking");
  EXPECT_NEAR(result.steps[0].parameters.at(0).value, 0.05, 0.001);
}

TEST(ObservationLevel, UndeclaredReadoutTimeIsNamedAndFound) {
  const ClosureResult result = closed(swaying_record(1000, {.readout_frames = 0.6}));
  ASSERT_EQ(result.steps.size(), 1U) << words(result);
  EXPECT_EQ(result.steps[0].effect, "readout time");
  EXPECT_NEAR(result.steps[0].parameters.at(0).value, 0.6, 0.03);
}

// The motions of the regions absorb most of it, and yet it delays the rows.
TEST(ObservationLevel, AReadoutTimeCountsByWhatItMovesThePointsBy) {
  ObservationLevel level(swaying_record(1000, {.readout_frames = 0.6}));
  ClosureOptions options;
  options.n_surrogates = 8;
  const ClosureStep step = close_loop(level, options).steps.at(0);
  const double drop_px = std::sqrt(std::pow(step.heldout_before, 2) - std::pow(step.heldout_after, 2));
  const double moves_px = level.size_of(0);
  ASSERT_GT(moves_px, 1.2 * drop_px);
  for (const double least_px : {0.5 * (drop_px + moves_px), 1.1 * moves_px}) {
    ObservationLevel again(swaying_record(1000, {.readout_frames = 0.6}));
    options.least_gain = least_px;
    EXPECT_EQ(close_loop(again, options).steps.size(), least_px < moves_px ? 1U : 0U) << least_px;
  }
}

TEST(ObservationLevel, AnEffectOutsideTheCatalogueIsLatentAndDescribed) {
  const ObservationRecord record = swaying_record(1000, {.roll_rms_rad = 0.03 * kPi / 180.0});
  ObservationLevel level(record);
  level.forget("camera roll");
  ClosureOptions options;
  options.n_surrogates = 8;
  const ClosureResult result = close_loop(level, options);
  ASSERT_EQ(result.steps.size(), 1U) << words(result);
  EXPECT_EQ(result.steps[0].kind, EffectKind::kLatent);
  EXPECT_LT(result.steps[0].heldout_after, 1.05 * result.noise_floor);
  EXPECT_NE(level.meaning(0).find("strongest at 0.2"), std::string::npos) << level.meaning(0);
}

TEST(ObservationLevel, AxesThatDifferByATenthOfADegreeChangeNothing) {
  ObservationRecord record = swaying_record(1000, {});
  for (std::size_t i = 0; i < record.regions.size(); ++i) record.regions[i].axis_deg = 0.1 * static_cast<double>(i);
  const ClosureResult result = closed(record);
  EXPECT_TRUE(result.steps.empty());
  EXPECT_NEAR(result.baseline_rms, result.noise_floor, 0.05 * result.noise_floor);
}

TEST(ObservationLevel, NothingIsNamedWithoutAnEffect) {
  const ClosureResult result = closed(swaying_record(1000, {}));
  EXPECT_TRUE(result.steps.empty()) << result.steps[0].effect;
  EXPECT_NEAR(result.baseline_rms, result.noise_floor, 0.03 * result.noise_floor);
}

// A point that slides over its texture, and one that jumps for a second.
void spoil(ObservationRecord& record) {
  NoiseStream noise(11);
  double slid_px = 0.0;
  for (Eigen::Index k = 0; k < record.n_frames(); ++k) {
    slid_px = 0.98 * slid_px + 0.1 * noise.gaussian();
    record.u_px(k, 13) += slid_px;
    if (k >= 300 && k < 325) record.v_px(k, 20) += 4.0;
  }
}

TEST(PointScreening, FindsTheBadPointAndTheJumpAndNothingElse) {
  ObservationRecord record = swaying_record(1000, {.roll_rms_rad = 0.1 * kPi / 180.0, .k1 = -0.3});
  ObservationRecord sound = record;
  EXPECT_TRUE(screen_points(sound).empty());
  EXPECT_EQ(sound.u_px, record.u_px);
  EXPECT_EQ(sound.sigma_px, record.sigma_px);
  spoil(record);
  EXPECT_EQ(screen_points(record).size(), 2U);
  for (Eigen::Index j = 0; j < record.n_points(); ++j)
    EXPECT_EQ(record.u_px.col(j).array().isNaN().count(), j == 13 ? 1000 : j == 20 ? 25 : 0) << j;
}

TEST(PointScreening, ADoubtfulPointCountsLess) {
  ObservationRecord record = swaying_record(1000, {});
  NoiseStream noise(12);
  for (Eigen::Index k = 0; k < record.n_frames(); ++k)
    record.u_px(k, 13) += 0.115 * noise.gaussian(), record.v_px(k, 13) += 0.115 * noise.gaussian();
  ASSERT_EQ(screen_points(record).size(), 1U);
  EXPECT_NEAR(record.sigma_px[13], 0.12, 0.015);
  EXPECT_FALSE(record.u_px.hasNaN());
}

TEST(ObservationLevel, ABadPointIsNotTakenForAnEffect) {
  ObservationRecord record = swaying_record(1000, {.roll_rms_rad = 0.03 * kPi / 180.0});
  spoil(record);
  const ClosureResult result = closed(record);
  ASSERT_EQ(result.steps.size(), 1U) << words(result);
  EXPECT_EQ(result.steps[0].effect, "camera roll");
  EXPECT_LT(result.steps[0].heldout_after, 1.05 * result.noise_floor);
}

TEST(ObservationLevel, LostSamplesAreFilledByTheModel) {
  ObservationRecord record = swaying_record(1000, {});
  for (Eigen::Index k = 0; k < 1000; ++k) record.u_px(k, k % 32) = std::numeric_limits<double>::quiet_NaN();
  const ClosureResult result = closed(record);
  EXPECT_TRUE(result.steps.empty());
  EXPECT_NEAR(result.baseline_rms, result.noise_floor, 0.06 * result.noise_floor);
}

TEST(ObservationLevel, BadRecordsAreRefusedInWords) {
  EXPECT_NE(fault({}).find("frame rate"), std::string::npos);
  EXPECT_NE(fault(swaying_record(100, {})).find("too short"), std::string::npos);
  ObservationRecord record = swaying_record(600, {});
  record.sigma_px.assign(32, std::nan(""));
  EXPECT_NE(fault(record).find("usable points"), std::string::npos);
  record = swaying_record(600, {});
  record.u_px.setConstant(500.0);
  EXPECT_NE(fault(record).find("one line"), std::string::npos);
  record = swaying_record(600, {});
  record.region_of_point[3] = 99;
  EXPECT_NE(fault(record).find("no declared region"), std::string::npos);
  record = swaying_record(600, {});
  record.v_px.setConstant(std::numeric_limits<double>::infinity());
  EXPECT_NE(fault(record).find("usable points"), std::string::npos);
}

TEST(ObservationLevel, SaysWhatOneRegionWithoutBackgroundCannotTell) {
  ObservationRecord record = swaying_record(600, {});
  record.region_of_point.assign(32, 1);
  const RecordCheck check = check_record(record);
  EXPECT_TRUE(check.faults.empty());
  ASSERT_EQ(check.warnings.size(), 2U);
  EXPECT_NE(check.warnings[0].find("one region"), std::string::npos);
  EXPECT_NE(check.warnings[1].find("no background"), std::string::npos);
}

}  // namespace
}  // namespace core::closure
