#include "core/closure/observation/noise_correlation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "core/closure/noise_stream.h"

namespace {

using core::closure::CorrelationShares;

constexpr Eigen::Index kPoints = 24, kFrames = 2048;
constexpr double kRate_hz = 30.0, kFrom_hz = 3.0;

// Two regions of 12 points each, 9 px apart along u.
struct Board {
  std::vector<std::size_t> region;
  Eigen::VectorXd places{2 * kPoints};
};

Board board() {
  Board out;
  for (Eigen::Index j = 0; j < kPoints; ++j) {
    out.region.push_back(j < kPoints / 2 ? 0 : 1);
    out.places(2 * j) = 100.0 + 9.0 * static_cast<double>(j % (kPoints / 2));
    out.places(2 * j + 1) = j < kPoints / 2 ? 100.0 : 300.0;
  }
  return out;
}

Eigen::MatrixXd white(std::uint64_t seed) {
  core::closure::NoiseStream noise(seed);
  Eigen::MatrixXd out(2 * kPoints, kFrames);
  for (Eigen::Index k = 0; k < kFrames; ++k) {
    for (Eigen::Index i = 0; i < out.rows(); ++i) out(i, k) = noise.gaussian();
  }
  return out;
}

// Removes the motion of each region along u, and the common motion along v.
Eigen::MatrixXd removal() {
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(2 * kPoints, 3);
  for (Eigen::Index j = 0; j < kPoints; ++j) x(2 * j, j < kPoints / 2 ? 0 : 1) = x(2 * j + 1, 2) = 1.0;
  for (Eigen::Index c = 0; c < 3; ++c) x.col(c).normalize();
  return Eigen::MatrixXd::Identity(2 * kPoints, 2 * kPoints) - x * x.transpose();
}

CorrelationShares measured(const Eigen::MatrixXd& noise) {
  const Board b = board();
  return core::closure::noise_correlation(removal() * noise, removal(), b.region, b.places, kRate_hz, kFrom_hz);
}

Eigen::MatrixXd correlated(const CorrelationShares& shares, std::uint64_t seed) {
  const Board b = board();
  return core::closure::PointCorrelation(shares, b.region, b.places).put_back(white(seed));
}

TEST(NoiseCorrelation, OfIndependentPointsIsNone) { EXPECT_TRUE(measured(white(1)).none()); }

TEST(NoiseCorrelation, FindsTheSharesThatTheFitLeaves) {
  const CorrelationShares found = measured(correlated({.window = 0.5, .neighbourhood = 0.0, .region_v = 0.25}, 2));
  EXPECT_NEAR(found.window, 0.5, 0.06);
  EXPECT_NEAR(found.neighbourhood, 0.0, 0.08);
  EXPECT_NEAR(found.region_v, 0.25, 0.06);
  EXPECT_EQ(found.region_u, 0.0);  // the fit removes it
}

TEST(NoiseCorrelation, ALineCommonToARegionIsNotNoise) {
  Eigen::MatrixXd noise = white(3);
  for (Eigen::Index k = 0; k < kFrames; ++k) {
    const double line = 2.0 * std::sin(2.0 * M_PI * 7.3 * static_cast<double>(k) / kRate_hz);
    for (Eigen::Index j = 0; j < kPoints / 2; ++j) noise(2 * j + 1, k) += line;
  }
  EXPECT_TRUE(measured(noise).none());
}

TEST(PointCorrelation, RemovedNoiseIsIndependent) {
  const Board b = board();
  const CorrelationShares shares{.window = 0.4, .neighbourhood = 0.2, .region_u = 0.1, .region_v = 0.2};
  const core::closure::PointCorrelation correlation(shares, b.region, b.places);
  const Eigen::MatrixXd noise = correlation.put_back(white(4));
  const auto moments = [](const Eigen::MatrixXd& values) -> Eigen::MatrixXd {
    return values * values.transpose() / static_cast<double>(kFrames);
  };
  EXPECT_NEAR(moments(noise)(0, 2), 0.4 * (1.0 - 9.0 / 21.0) + 0.2 * std::exp(-9.0 / 40.0) + 0.1, 0.08);
  EXPECT_LT(
      (moments(correlation.removed(noise)) - Eigen::MatrixXd::Identity(2 * kPoints, 2 * kPoints)).cwiseAbs().maxCoeff(),
      0.15);
  EXPECT_LT((correlation.removed(noise) - white(4)).norm(), 1e-9 * noise.norm());
  EXPECT_NEAR(moments(noise)(0, 2 * (kPoints / 2)), 0.0, 0.1);  // points of different regions
}

}  // namespace
