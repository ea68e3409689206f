#include "core/closure/observation/frame_shift.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/closure/noise_stream.h"
#include "tests/support/swaying_record.h"

namespace core::closure {
namespace {

using test_support::kPi;

constexpr Eigen::Index kFrames = 1500;

// Sum of sines up to 0.45 of the rate, on a drift of many times their size: value and derivative in closed form.
struct Motion {
  [[nodiscard]] static double at(double k) {
    double sum = 40.0 * std::sin(0.011 * k);
    for (const double cycles : {0.03, 0.21, 0.45}) sum += std::sin(2.0 * kPi * cycles * k + 7.0 * cycles);
    return sum;
  }
  [[nodiscard]] static double rate(double k) {
    double sum = 40.0 * 0.011 * std::cos(0.011 * k);
    for (const double cycles : {0.03, 0.21, 0.45})
      sum += 2.0 * kPi * cycles * std::cos(2.0 * kPi * cycles * k + 7.0 * cycles);
    return sum;
  }
};

Eigen::MatrixXd motion(Eigen::Index rows) {
  Eigen::MatrixXd out(rows, kFrames);
  for (Eigen::Index k = 0; k < kFrames; ++k) out.col(k).setConstant(Motion::at(static_cast<double>(k)));
  return out;
}

TEST(FrameShift, AdvancedSeriesAreTheMotionAtTheOtherInstants) {
  const Eigen::Vector3d frames(-0.5, 0.13, 0.5);
  Eigen::MatrixXd series = motion(3);
  FrameShift(kFrames).advance(series, frames);
  double worst = 0.0;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index k = 60; k < kFrames - 60; ++k)
      worst = std::max(worst, std::abs(series(row, k) - Motion::at(static_cast<double>(k) + frames(row))));
  }
  EXPECT_LT(worst, 5e-3);
}

TEST(FrameShift, WhiteNoiseKeepsItsVarianceAtAnyInstant) {
  NoiseStream noise(9);
  Eigen::MatrixXd series(8, kFrames);
  for (double& value : series.reshaped()) value = noise.gaussian();
  const double before = series.squaredNorm();
  FrameShift(kFrames).advance(series, Eigen::VectorXd::LinSpaced(8, -0.5, 0.5));
  EXPECT_NEAR(series.squaredNorm() / before, 1.0, 0.01);
}

TEST(FrameShift, RatesAreThoseOfTheMotionAndNotOfItsNoise) {
  NoiseStream noise(10);
  constexpr double kSigma = 0.05;
  Eigen::MatrixXd series = motion(1);
  for (double& value : series.reshaped()) value += kSigma * noise.gaussian();
  const Eigen::MatrixXd rates = FrameShift(kFrames).signal_rates(series, kSigma * kSigma);
  double squares = 0.0;
  for (Eigen::Index k = 60; k < kFrames - 60; ++k)
    squares += std::pow(rates(0, k) - Motion::rate(static_cast<double>(k)), 2) / static_cast<double>(kFrames - 120);
  EXPECT_LT(std::sqrt(squares), 0.6 * kPi / std::sqrt(3.0) * kSigma);  // of what the noise alone differentiates to
}

}  // namespace
}  // namespace core::closure
