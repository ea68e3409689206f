#include "core/geometry/motion_process.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>

namespace core {
namespace {

constexpr double kCorner_hz = 0.5, kLambda = 2.0 * std::numbers::pi * kCorner_hz;
constexpr double kLong_s = 100.0;  // many correlation times

MotionVector deviations() {
  MotionVector sd;
  sd << 0.01, 0.02, 0.03, 5.0, 6.0, 7.0, 0.004, 0.005;
  return sd;
}

// In its stationary state, with every component known to be one of its deviations.
MotionProcess displaced() {
  MotionProcess process(kCorner_hz);
  process.start(deviations());
  process.predict(kLong_s, deviations());
  MotionMatrix exact = MotionMatrix::Zero();
  exact.diagonal() = 1e10 * deviations().cwiseAbs2().cwiseInverse();
  MotionStateVector step;
  EXPECT_TRUE(process.step(exact, exact * deviations(), step));
  process.accept(step);
  return process;
}

// Matern, nu = 5/2.
double correlation(double tau_s) {
  const double x = kLambda * tau_s;
  return (1.0 + x + x * x / 3.0) * std::exp(-x);
}

TEST(MotionProcess, KeyframeIsKnownAndNoDataMoveIt) {
  MotionProcess process(kCorner_hz);
  process.start(deviations());
  EXPECT_EQ(process.mean().norm(), 0.0);
  const MotionMatrix none = process.covariance().topLeftCorner<kMotionSize, kMotionSize>();
  EXPECT_EQ(none.norm(), 0.0);
  MotionStateVector step;
  ASSERT_TRUE(process.step(1e6 * MotionMatrix::Identity(), MotionVector::Constant(1e6), step));
  EXPECT_EQ(step.norm(), 0.0);
}

TEST(MotionProcess, ForgetsTheKeyframeAndHasThePriorsVariances) {
  MotionProcess process(kCorner_hz);
  process.start(deviations());
  process.predict(kLong_s, deviations());
  const double l2 = kLambda * kLambda;
  for (int i = 0; i < kMotionSize; ++i) {
    const double variance = deviations()(i) * deviations()(i);
    const auto of = [&](int a, int b) { return process.covariance()(a * kMotionSize + i, b * kMotionSize + i); };
    EXPECT_NEAR(of(0, 0) / variance, 1.0, 1e-9);
    EXPECT_NEAR(of(1, 1) / variance, l2 / 3.0, 1e-9 * l2);
    EXPECT_NEAR(of(2, 2) / variance, l2 * l2, 1e-9 * l2 * l2);
    EXPECT_NEAR(of(0, 2) / variance, -l2 / 3.0, 1e-9 * l2);
    EXPECT_NEAR(of(0, 1) / variance, 0.0, 1e-9);
  }
}

// Both branches of the process noise: below and above half a time constant.
TEST(MotionProcess, PredictsByTheMaternCorrelation) {
  for (const double dt_s : {0.02, 0.1, 0.15, 0.17, 0.5, 2.0}) {
    MotionProcess process = displaced();
    process.predict(dt_s, deviations());
    const double r = correlation(dt_s);
    for (int i = 0; i < kMotionSize; ++i) {
      EXPECT_NEAR(process.mean()(i) / deviations()(i), r, 1e-8) << dt_s;
      EXPECT_NEAR(process.covariance()(i, i) / (deviations()(i) * deviations()(i)), 1.0 - r * r, 1e-8) << dt_s;
    }
  }
}

TEST(MotionProcess, ManyShortStepsAreOneLongStep) {
  MotionProcess once = displaced(), often = once;
  once.predict(0.6, deviations());
  for (int k = 0; k < 30; ++k) often.predict(0.02, deviations());
  EXPECT_LT((once.mean() - often.mean()).norm(), 1e-9 * once.mean().norm());
  EXPECT_LT((once.covariance() - often.covariance()).norm(), 1e-9 * once.covariance().norm());
}

TEST(MotionProcess, ADatumIsWeighedAgainstThePriorAndLeavesTheRestAsItWas) {
  MotionProcess process(kCorner_hz);
  process.start(deviations());
  process.predict(kLong_s, deviations());
  const MotionStateMatrix before = process.covariance();
  constexpr double kSigma = 2.0, kSeen = 3.0;  // mm, of a shift whose deviation is 5 mm
  MotionMatrix information = MotionMatrix::Zero();
  MotionVector rhs = MotionVector::Zero();
  information(kShiftX, kShiftX) = 1.0 / (kSigma * kSigma);
  rhs(kShiftX) = kSeen / (kSigma * kSigma);
  MotionStateVector step;
  ASSERT_TRUE(process.step(information, rhs, step));
  process.accept(step);
  const double variance = 1.0 / (1.0 / 25.0 + 1.0 / (kSigma * kSigma));
  EXPECT_NEAR(process.covariance()(kShiftX, kShiftX), variance, 1e-12 * variance);
  EXPECT_NEAR(process.mean()(kShiftX), variance * kSeen / (kSigma * kSigma), 1e-12);
  // What is known of a stationary process says nothing about its rate, and of its curvature the opposite sign.
  EXPECT_NEAR(process.mean()(kMotionSize + kShiftX), 0.0, 1e-9);
  EXPECT_LT(process.mean()(2 * kMotionSize + kShiftX), 0.0);
  for (const int i : {kPitch, kRoll, kShiftY, kFaceY}) {
    EXPECT_EQ(process.mean()(i), 0.0);
    EXPECT_NEAR(process.covariance()(i, i), before(i, i), 1e-12 * before(i, i));
  }
}

TEST(MotionProcess, CovarianceStaysPositiveSemidefiniteOverLongAndRepeatedData) {
  MotionProcess process(kCorner_hz);
  process.start(deviations());
  const MotionMatrix information = 1e12 * MotionMatrix::Identity();
  MotionStateVector step;
  for (int k = 0; k < 2000; ++k) {
    process.predict(k % 7 == 0 ? 0.0 : 0.01, deviations());
    ASSERT_TRUE(process.step(information, MotionVector::Constant(1e3), step));
    process.accept(step);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Eigen::MatrixXd(process.covariance()));
  EXPECT_GE(eigen.eigenvalues().minCoeff(), -1e-12 * eigen.eigenvalues().maxCoeff());
}

TEST(MotionProcess, TimeThatRunsBackwardsCountsAsNone) {
  MotionProcess process = displaced();
  const MotionStateVector mean = process.mean();
  process.predict(-1.0, deviations());
  EXPECT_LT((process.mean() - mean).norm(), 1e-15 * mean.norm());
}

TEST(MotionProcess, RefusesDataThatAreNotFinite) {
  MotionProcess process = displaced();
  MotionStateVector step;
  EXPECT_FALSE(
      process.step(MotionMatrix::Identity(), MotionVector::Constant(std::numeric_limits<double>::quiet_NaN()), step));
}

TEST(MotionProcess, PositionBesideTheInstantFollowsRateAndCurvature) {
  MotionStateVector state = MotionStateVector::Zero();
  state(kRoll) = 1.0, state(kMotionSize + kRoll) = 2.0, state(2 * kMotionSize + kRoll) = 6.0;
  EXPECT_DOUBLE_EQ(MotionProcess::at(state, 0.5)(kRoll), 1.0 + 1.0 + 0.75);
  EXPECT_DOUBLE_EQ(MotionProcess::at(state, -0.5)(kRoll), 1.0 - 1.0 + 0.75);
}

}  // namespace
}  // namespace core
