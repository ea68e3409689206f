#include "core/geometry/derotated_flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace core {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr DerotatedFlowModel kModel{600.0, 0.1};

// Static points over 800 x 600 px at many depths, seen by a camera that moves by shift_px.
std::vector<DerotatedFlow> flows_of(const Vector3d& shift_px, std::uint64_t seed, int n = 80) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::normal_distribution<double> noise(0.0, kModel.sigma_px), depth(0.0, 1.0);
  std::vector<DerotatedFlow> flows(static_cast<std::size_t>(n));
  for (DerotatedFlow& flow : flows) {
    flow.at_px = {400.0 * unit(random), 300.0 * unit(random)};
    flow.flow_px = shift_effect(flow, kModel.focal_px) * shift_px * (1.0 + depth(random));
    flow.flow_px += Vector2d{noise(random), noise(random)};
  }
  return flows;
}

TEST(DerotatedFlow, TranslationAlongTheAxisMovesPointsFromTheMiddleOutwards) {
  const DerotatedFlow point{{60.0, -30.0}, {}};
  const Vector2d ahead = shift_effect(point, 600.0) * Vector3d(0.0, 0.0, -10.0);
  EXPECT_NEAR((ahead - Vector2d(1.0, -0.5)).norm(), 0.0, 1e-14);
  const Vector2d aside = shift_effect(point, 600.0) * Vector3d(3.0, 4.0, 0.0);
  EXPECT_NEAR((aside - Vector2d(3.0, 4.0)).norm(), 0.0, 1e-14);
}

// d = (4, 0): sigma along the epipolar line sqrt(0.01 + 16), across it 0.1.
TEST(DerotatedFlow, APointOfMeanDepthHasTheLeastCostAndTheFullWeight) {
  const DerotatedFlowTerm term = judge({{0.0, 0.0}, {4.0, 0.0}}, {4.0, 0.0, 0.0}, kModel);
  EXPECT_DOUBLE_EQ(term.weight, 5.0 / 3.0);
  EXPECT_DOUBLE_EQ(term.across_px, 0.0);
  EXPECT_NEAR(term.cost, 0.5 * std::log(16.01 * 0.01), 1e-12);
  EXPECT_NEAR(term.flow_information(0, 0), 1.0 / 16.01, 1e-12);
  EXPECT_NEAR(term.flow_information(1, 1), 100.0, 1e-9);
  EXPECT_NEAR(term.flow_information(0, 1), 0.0, 1e-12);
}

// Three sigmas off the epipolar line: distance^2 = 9.
TEST(DerotatedFlow, WeightFallsWithTheDistanceFromTheEpipolarLine) {
  const DerotatedFlowTerm term = judge({{0.0, 0.0}, {4.0, 0.3}}, {4.0, 0.0, 0.0}, kModel);
  EXPECT_NEAR(term.across_px, 0.3, 1e-12);
  EXPECT_NEAR(term.weight, 5.0 / 12.0, 1e-9);
  EXPECT_NEAR(term.cost, 2.5 * std::log(4.0) + 0.5 * std::log(16.01 * 0.01), 1e-9);
}

// A point twice as near as the mean: the epipolar line allows that.
TEST(DerotatedFlow, DepthCostsLittleAlongTheLineAndMuchAcrossIt) {
  const Vector3d shift(4.0, 0.0, 0.0);
  const double mean = judge({{0.0, 0.0}, {4.0, 0.0}}, shift, kModel).cost;
  EXPECT_LT(judge({{0.0, 0.0}, {8.0, 0.0}}, shift, kModel).cost - mean, 0.8);
  EXPECT_GT(judge({{0.0, 0.0}, {4.0, 4.0}}, shift, kModel).cost - mean, 10.0);
}

TEST(DerotatedFlow, SlopeIsTheCostsDerivative) {
  constexpr double kStep = 1e-5;
  const std::vector<Vector2d> flows{{4.0, 0.0}, {1.0, 0.25}, {-2.0, 3.0}, {0.05, -0.02}};
  for (const Vector2d& flow : flows) {
    for (const Vector3d& shift : {Vector3d(3.0, 1.0, 0.0), Vector3d(-0.4, 0.7, 0.0), Vector3d(0.02, 0.01, 0.0)}) {
      const DerotatedFlow point{{0.0, 0.0}, flow};  // in the middle: d = shift
      const Vector2d slope = judge(point, shift, kModel).slope;
      for (int axis = 0; axis < 2; ++axis) {
        const Vector3d move = kStep * Vector3d::Unit(axis);
        const double difference =
            (judge(point, shift + move, kModel).cost - judge(point, shift - move, kModel).cost) / (2.0 * kStep);
        EXPECT_NEAR(slope(axis), difference, 1e-4 * (1.0 + std::abs(difference)))
            << flow.transpose() << " at " << shift.transpose();
      }
    }
  }
}

TEST(DerotatedFlow, CostIsTheSumOverThePoints) {
  const Vector3d shift(2.0, -1.0, 3.0);
  const std::vector<DerotatedFlow> flows = flows_of(shift, 1, 5);
  double sum = 0.0;
  for (const DerotatedFlow& flow : flows) sum += judge(flow, shift, kModel).cost;
  EXPECT_DOUBLE_EQ(cost(flows, shift, kModel), sum);
  EXPECT_EQ(cost({}, shift, kModel), 0.0);
}

double degrees_between(const Vector3d& a, const Vector3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0)) * 57.29577951308232;
}

TEST(DerotatedFlow, FitFindsTheTranslationFromFarAndTheCostFalls) {
  const Vector3d truth(6.0, -3.0, 8.0);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<DerotatedFlow> flows = flows_of(truth, seed);
    Vector3d found(1.0, 0.0, 0.0);
    const double before = cost(flows, found, kModel);
    const double after = fit_shift(flows, kModel, found);
    EXPECT_LT(after, before) << seed;
    EXPECT_DOUBLE_EQ(after, cost(flows, found, kModel)) << seed;
    EXPECT_LE(after, cost(flows, truth, kModel)) << seed;
    EXPECT_LT(degrees_between(found, truth), 2.0) << seed;
    EXPECT_NEAR(found.norm() / truth.norm(), 1.0, 0.35) << seed;  // the depths' own scatter decides its size
  }
}

TEST(DerotatedFlow, FitReachesTheSameTranslationFromEveryStart) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const std::vector<DerotatedFlow> flows = flows_of({6.0, -3.0, 8.0}, seed);
    Vector3d reference(6.0, -3.0, 8.0);
    const double least = fit_shift(flows, kModel, reference);
    for (const Vector3d& start : {Vector3d(1, 0, 0), Vector3d(0, 0, 1), Vector3d(5, -5, 5), Vector3d(0.1, 0.1, 0.1)}) {
      Vector3d found = start;
      EXPECT_NEAR(fit_shift(flows, kModel, found), least, 1e-4 * std::abs(least)) << seed;
      EXPECT_LT((found - reference).norm(), 0.02 * reference.norm()) << seed;
    }
  }
}

TEST(DerotatedFlow, LeverIsTheFlowAlongTheLineOverTheLength) {
  const Eigen::Matrix2d lever = depth_lever({{0.0, 0.0}, {6.0, 1.0}}, {2.0, 0.0});
  EXPECT_NEAR((lever - Eigen::Matrix2d(Vector2d(1.0, 3.0).asDiagonal())).norm(), 0.0, 1e-14);
  EXPECT_EQ(depth_lever({{0.0, 0.0}, {6.0, 1.0}}, {0.0, 0.0}), Eigen::Matrix2d::Identity());
}

TEST(DerotatedFlow, FitIsNotPulledByMovingObjects) {
  const Vector3d truth(6.0, -3.0, 8.0);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::vector<DerotatedFlow> flows = flows_of(truth, seed);
    for (std::size_t i = 0; i < flows.size(); i += 8) flows[i].flow_px += Vector2d{-15.0, 25.0};
    Vector3d found(1.0, 0.0, 0.0);
    (void)fit_shift(flows, kModel, found);
    EXPECT_LT(degrees_between(found, truth), 3.0) << seed;
  }
}

TEST(DerotatedFlow, OfNoPointsTheStartIsKept) {
  Vector3d found(1.0, 2.0, 3.0);
  EXPECT_EQ(fit_shift({}, kModel, found), 0.0);
  EXPECT_EQ(found, Vector3d(1.0, 2.0, 3.0));
}

}  // namespace
}  // namespace core
