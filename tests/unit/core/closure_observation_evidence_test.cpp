#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "core/closure/closure_loop.h"
#include "core/closure/noise_stream.h"
#include "core/closure/observation/block_estimates.h"
#include "core/closure/observation/observation_level.h"
#include "core/closure/observation/point_noise.h"
#include "core/closure/observation/rungs.h"
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

double seconds(Eigen::Index k) { return static_cast<double>(k) / 25.0; }

Eigen::MatrixXd white(Eigen::Index rows, Eigen::Index cols, std::uint64_t seed) {
  NoiseStream noise(seed);
  Eigen::MatrixXd out(rows, cols);
  for (double& value : out.reshaped()) value = noise.gaussian();
  return out;
}

TEST(PointNoise, IsThatOfEachPointBesideALineInAllOfThem) {
  const Eigen::Index n = 12, frames = 3000;
  Eigen::MatrixXd x = white(2 * n, frames, 3);
  for (Eigen::Index j = 0; j < n; ++j) x.middleRows(2 * j, 2) *= 0.5 + 0.1 * static_cast<double>(j);
  for (Eigen::Index k = 0; k < frames; ++k) x.col(k).array() += 3.0 * std::sin(2.0 * kPi * 5.0 * seconds(k));
  const Eigen::MatrixXd q = Eigen::MatrixXd::Constant(2 * n, 1, 1.0 / std::sqrt(2.0 * n));
  x -= q * (q.transpose() * x).eval();
  for (Eigen::Index k = 0; k < frames; ++k) x.topRows(n).col(k).array() += 2.0 * std::sin(2.0 * kPi * 7.0 * seconds(k));
  const Eigen::VectorXd noise = point_noise(x, q, 25.0, 3.0);
  for (Eigen::Index j = 0; j < n; ++j) EXPECT_NEAR(noise(j), 0.5 + 0.1 * static_cast<double>(j), 0.06 * noise(j)) << j;
}

TEST(BlockEstimates, WhiteNoiseIsAsItsFormulaAndASlowErrorIsNot) {
  const std::vector<Eigen::MatrixXd> fields{white(20, 2000, 5)};
  Eigen::MatrixXd residual = white(20, 2000, 6) + 0.05 * fields[0];
  const BlockEstimates plain(fields, residual);
  const double formula = 1.0 / fields[0].norm();
  EXPECT_NEAR(plain.values()(0), 0.05, 4.0 * formula);
  EXPECT_LT(std::sqrt(plain.covariance()(0, 0)), 2.0 * formula);
  EXPECT_GT(plain.sigmas_from_zero(), 3.0);
  EXPECT_GT(plain.held_out_gain(), 20.0);
  // The same size, with a sign that changes from block to block: nothing of the whole record.
  for (Eigen::Index k = 0; k < 2000; ++k)
    residual.col(k) -= (0.05 + (k / 200 % 2 == 0 ? 0.3 : -0.28)) * fields[0].col(k);
  const BlockEstimates changing(fields, residual);
  EXPECT_GT(std::sqrt(changing.covariance()(0, 0)), 5.0 * formula);
  EXPECT_LT(changing.sigmas_from_zero(), 3.0);
}

TEST(BlockEstimates, CompactFieldsGiveTheSameNumbers) {
  const std::vector<Eigen::MatrixXd> fields{white(20, 2000, 5), white(20, 2000, 7)};
  const Eigen::MatrixXd residual = white(20, 2000, 6) + 0.05 * fields[0] - 0.02 * fields[1];
  const std::vector<CompactField> kept{CompactField(fields[0]), CompactField(fields[1])};
  const std::vector<const CompactField*> pointers{&kept[0], &kept[1]};
  const LeaveOnePointOut nothing_fitted(Eigen::MatrixXd(20, 0));
  const BlockEstimates all(fields, residual), compact(pointers, LeftOutErrors(nothing_fitted, residual));
  EXPECT_TRUE(compact.values().isApprox(all.values(), 2e-5));
  EXPECT_TRUE(compact.covariance().isApprox(all.covariance(), 1e-4));
  EXPECT_NEAR(compact.held_out_gain(), all.held_out_gain(), 2e-5 * all.held_out_gain());
}

TEST(CompactField, IsOffByHalfAStepAtMost) {
  const Eigen::MatrixXd field = 1e-4 * white(20, 300, 5);
  const CompactField compact(field);
  ASSERT_EQ(compact.cols(), field.cols());
  const double off = (compact.middleCols(0, 300) - field).cwiseAbs().maxCoeff();
  EXPECT_LE(off, 0.5001 * field.cwiseAbs().maxCoeff() / 32767.0);
  EXPECT_EQ(CompactField(Eigen::MatrixXd::Zero(4, 5)).middleCols(1, 3).sum(), 0.0);
}

TEST(Rungs, TheirCosinesAreOrthonormalAndShareTheSpectrum) {
  const Rungs rungs(25.0);
  const RungSet slow = rungs.up_to(3.0);
  EXPECT_NEAR(rungs.width_hz(slow), 3.0, 1e-12);
  EXPECT_NEAR(rungs.width_hz(kAllRungs), 12.5, 1e-12);
  const Eigen::MatrixXd cosines = rungs.cosines(500, slow);
  EXPECT_NEAR(static_cast<double>(cosines.cols()), 120.0, 1.0);
  EXPECT_TRUE((cosines.transpose() * cosines).isIdentity(1e-9));
  EXPECT_EQ(rungs.cosines(500, slow).cols() + rungs.cosines(500, ~slow).cols(), 500);
}

TEST(ObservationLevel, NoiseStatedWrongIsNeitherStructureNorAnObstacle) {
  ObservationRecord record = swaying_record(1500, {.readout_frames = 0.1});
  for (std::size_t j = 0; j < record.sigma_px.size(); ++j) record.sigma_px[j] *= j % 2 == 0 ? 0.6 : 1.1;
  const ClosureResult result = closed(record);
  ASSERT_EQ(result.steps.size(), 1U) << words(result);
  EXPECT_EQ(result.steps[0].effect, "readout time");
  EXPECT_NEAR(result.noise_floor, 0.03, 0.003);
  EXPECT_LT(result.steps[0].heldout_after, 1.03 * result.noise_floor);
}

TEST(ObservationLevel, AnObliqueViewIsNamedWithItsAngles) {
  ObservationRecord record = swaying_record(1500, {});
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(-12.0 * kPi / 180.0, Eigen::Vector3d::UnitY()).toRotationMatrix();
  for (Eigen::Index j = 0; j < record.n_points(); ++j) {
    for (Eigen::Index k = 0; k < record.n_frames(); ++k) {
      const Eigen::Vector3d ray(record.u_px(k, j) - record.cx_px, record.v_px(k, j) - record.cy_px, record.alpha_px);
      const Eigen::Vector2d seen = record.alpha_px * (turn * ray).hnormalized();
      record.u_px(k, j) = record.cx_px + seen.x(), record.v_px(k, j) = record.cy_px + seen.y();
    }
  }
  const ClosureResult result = closed(record);
  ASSERT_EQ(result.steps.size(), 1U) << words(result);
  EXPECT_EQ(result.steps[0].effect, "oblique view");
  const auto& parameters = result.steps[0].parameters;
  ASSERT_EQ(parameters.size(), 2U);
  EXPECT_NEAR(parameters[0].value, 0.0, 4.0 * parameters[0].sigma.value_or(0.0));
  EXPECT_NEAR(parameters[1].value, 12.0, 4.0 * parameters[1].sigma.value_or(0.0));
}

TEST(ObservationLevel, APartThatMovesByItselfIsNamedWithItsFrequency) {
  ObservationRecord record = swaying_record(1500, {});
  for (Eigen::Index j = 20; j < 24; ++j) {
    for (Eigen::Index k = 0; k < record.n_frames(); ++k)
      record.u_px(k, j) += 0.06 * std::sin(2.0 * kPi * 3.6 * seconds(k));
  }
  const ClosureResult result = closed(record);
  ASSERT_EQ(result.steps.size(), 1U) << words(result);
  EXPECT_EQ(result.steps[0].effect, "moving part");
  EXPECT_NEAR(result.steps[0].parameters.at(1).value, 3.6, 0.05);
}

// Floors turned exactly about an upright axis so many px from the middle of the points, with the camera's own motion: a
// point goes away by its distance from the axis times the angle, and comes nearer to it.
class FloorsThatTurnFar : public ::testing::TestWithParam<double> {};

TEST_P(FloorsThatTurnFar, AreNamedAndLeaveNothing) {
  ObservationRecord record = swaying_record(1500, {});
  for (Eigen::Index j = 8; j < record.n_points(); ++j) {
    const double across = -150.0 + 43.3 * static_cast<double>(j % 8) - 1.55 - GetParam();
    const Eigen::Index region = j / 8;
    const double share = static_cast<double>(region) / 3.0;
    for (Eigen::Index k = 0; k < record.n_frames(); ++k) {
      const double turn = share * 0.1 * std::sin(2.0 * kPi * 3.3 * seconds(k));
      const double away = std::sin(turn) * across / record.alpha_px, nearer = across * (std::cos(turn) - 1.0);
      record.u_px(k, j) = record.cx_px + (record.u_px(k, j) - record.cx_px + nearer) / (1.0 + away);
      record.v_px(k, j) = record.cy_px + (record.v_px(k, j) - record.cy_px) / (1.0 + away);
    }
  }
  const ClosureResult result = closed(record);
  ASSERT_EQ(result.steps.size(), 1U) << words(result);
  EXPECT_EQ(result.steps[0].effect, "torsion");
  EXPECT_NEAR(result.steps[0].parameters.at(1).value, 3.3, 0.05);
  EXPECT_LT(result.residual_rms, 1.02 * result.noise_floor);
}

INSTANTIATE_TEST_SUITE_P(ObservationLevel, FloorsThatTurnFar, ::testing::Values(0.0, 10.0));

TEST(ObservationLevel, RockingIsNoRollWhereTheBackgroundStandsStill) {
  ObservationRecord record = swaying_record(1500, {});
  record.regions[0].role = core::RegionRole::kBackground;
  for (Eigen::Index j = 8; j < record.n_points(); ++j) {
    for (Eigen::Index k = 0; k < record.n_frames(); ++k) {
      const double turn = 5e-4 * std::sin(2.0 * kPi * 2.3 * seconds(k));
      const double x = record.u_px(k, j) - record.cx_px, y = record.v_px(k, j) - 900.0;
      record.u_px(k, j) -= turn * y, record.v_px(k, j) += turn * x;
    }
  }
  const ClosureResult result = closed(record);
  ASSERT_EQ(result.steps.size(), 1U) << words(result);
  EXPECT_EQ(result.steps[0].effect, "rocking");
  EXPECT_NEAR(result.steps[0].parameters.at(0).value, 5e-4 / std::sqrt(2.0) * 180.0 / kPi, 0.002);
}

// A turn at this frequency about the point (cx, about_v) in a record without a background.
ClosureResult closed_with_turn(double frequency_hz, double about_v, double readout_frames) {
  ObservationRecord record = swaying_record(1500, {.readout_frames = readout_frames});
  record.readout_frames = readout_frames;
  for (Eigen::Index j = 0; j < record.n_points(); ++j) {
    for (Eigen::Index k = 0; k < record.n_frames(); ++k) {
      const double t = seconds(k) + readout_frames * record.v_px(k, j) / record.height_px / record.rate_hz;
      const double turn = 5e-4 * std::sin(2.0 * kPi * frequency_hz * t);
      const double x = record.u_px(k, j) - record.cx_px, y = record.v_px(k, j) - about_v;
      record.u_px(k, j) -= turn * y, record.v_px(k, j) += turn * x;
    }
  }
  return closed(record);
}

TEST(ObservationLevel, WithoutABackgroundTheBaseTellsRockingFromTheCamerasRoll) {
  const double base_v = swaying_record(100, {}).v_px.leftCols(8).mean();
  const ClosureResult rocks = closed_with_turn(2.3, base_v, 0.0);
  ASSERT_EQ(rocks.steps.size(), 1U) << words(rocks);
  EXPECT_EQ(rocks.steps[0].effect, "rocking");
  EXPECT_TRUE(rocks.steps[0].rivals.empty());
  const ClosureResult rolls = closed_with_turn(2.3, 540.0, 0.0);
  ASSERT_EQ(rolls.steps.size(), 1U) << words(rolls);
  EXPECT_EQ(rolls.steps[0].effect, "camera roll");
}

TEST(ObservationLevel, ANarrowBandOfRollAboveTheDriftIsAVibration) {
  const ClosureResult result = closed_with_turn(6.3, 540.0, 0.5);
  ASSERT_EQ(result.steps.size(), 1U) << words(result);
  EXPECT_EQ(result.steps[0].effect, "camera vibration");
}

// Every point of a floor moves in its own way: none of these motions is that of a part.
TEST(ObservationLevel, ARegionThatMovesInManyWaysHasNoMovingPart) {
  ObservationRecord record = swaying_record(1500, {});
  for (Eigen::Index j = 16; j < 24; ++j) {
    const double hz = 2.0 + 0.7 * static_cast<double>(j - 16);
    for (Eigen::Index k = 0; k < record.n_frames(); ++k)
      record.u_px(k, j) += 0.06 * std::sin(2.0 * kPi * hz * seconds(k));
  }
  for (const ClosureStep& step : closed(record).steps) EXPECT_NE(step.effect, "moving part");
}

TEST(ObservationLevel, TwoRadialTermsAreFittedTogether) {
  ObservationRecord record = swaying_record(1500, {});
  const double k1 = -0.2, k2 = 0.5;
  for (Eigen::Index j = 0; j < record.n_points(); ++j) {
    for (Eigen::Index k = 0; k < record.n_frames(); ++k) {
      const double x = record.u_px(k, j) - record.cx_px, y = record.v_px(k, j) - record.cy_px;
      const double r2 = (x * x + y * y) / (record.alpha_px * record.alpha_px), bent = 1.0 + r2 * (k1 + k2 * r2);
      record.u_px(k, j) = record.cx_px + bent * x, record.v_px(k, j) = record.cy_px + bent * y;
    }
  }
  const ClosureResult result = closed(record);
  for (const ClosureStep& step : result.steps) {
    for (const ParameterValue& p : step.parameters)
      EXPECT_NEAR(p.value, p.name == "k1" ? k1 : p.name == "k2" ? k2 : 0.0, 4.0 * p.sigma.value_or(0.0)) << p.name;
  }
  EXPECT_EQ(result.steps.size(), 2U) << words(result);
}

}  // namespace
}  // namespace core::closure
