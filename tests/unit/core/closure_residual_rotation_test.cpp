#include "core/closure/observation/residual_rotation.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

namespace core::closure {
namespace {

using Eigen::Vector3d;

constexpr DerotatedFlowModel kModel{600.0, 0.1};

// Points over an image of 800 x 600 px that rotates, with a camera translated relative to points at many depths.
std::vector<DerotatedFlow> flows_of(const Vector3d& turn, const Vector3d& shift_px, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::normal_distribution<double> noise(0.0, kModel.sigma_px), depth(0.0, 1.0);
  std::vector<DerotatedFlow> flows;
  for (int i = 0; i < 60; ++i) {
    const double x = 400.0 * unit(random), y = 300.0 * unit(random), f = kModel.focal_px;
    DerotatedFlow flow;
    flow.at_px = {x, y};
    flow.flow_px = shift_effect(flow, f) * shift_px * (1.0 + depth(random));
    flow.flow_px += Eigen::Vector2d(x * y / f * turn.x() - (f + x * x / f) * turn.y() + y * turn.z(),
                                    (f + y * y / f) * turn.x() - x * y / f * turn.y() - x * turn.z());
    flow.flow_px += Eigen::Vector2d{noise(random), noise(random)};
    flows.push_back(flow);
  }
  return flows;
}

TEST(ResidualRotation, IsFoundBesideAShiftPastManyDepths) {
  const Vector3d turn(0.002, -0.003, 0.004);
  double squares = 0.0;
  constexpr int kSeeds = 60;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const ResidualRotation found = residual_rotation(flows_of(turn, {2.0, -1.0, 6.0}, static_cast<std::uint64_t>(seed)),
                                                     kModel, Vector3d(0, 0, 1));
    const Vector3d off = found.rotation - turn;
    EXPECT_LT(off.dot(found.information * off), 21.0) << seed;  // chi-square of three: 99.99 %
    EXPECT_LT(off.norm(), 0.1 * turn.norm()) << seed;
    squares += off.dot(found.information * off) / 3.0;
  }
  EXPECT_NEAR(squares / kSeeds, 1.0, 0.4);  // scatter as stated, within the accuracy of sixty seeds
}

TEST(ResidualRotation, OfNoneIsNearNone) {
  const ResidualRotation found =
      residual_rotation(flows_of(Vector3d::Zero(), {2.0, -1.0, 6.0}, 1), kModel, Vector3d(0, 0, 1));
  EXPECT_LT(found.rotation.dot(found.information * found.rotation), 16.0);  // chi-square of three: 99.9 %
}

// A steady rotation about the image's own axes looks like a translation if all depths are equal and the view is narrow.
TEST(ResidualRotation, SaysThatANarrowViewCannotTellItFromAShift) {
  std::vector<DerotatedFlow> wide = flows_of(Vector3d::Zero(), {2.0, 0.0, 0.0}, 1), narrow = wide;
  for (DerotatedFlow& flow : narrow) flow.at_px *= 0.05;
  const Vector3d shift(2.0, 0.0, 0.0);
  const double told = residual_rotation(wide, kModel, shift).information(1, 1);
  EXPECT_LT(residual_rotation(narrow, kModel, shift).information(1, 1), 0.2 * told);
}

TEST(ResidualRotation, OfNoPointsTellsNothing) {
  const ResidualRotation found = residual_rotation({}, kModel, Vector3d(0, 0, 1));
  EXPECT_EQ(found.rotation, Vector3d::Zero());
  EXPECT_EQ(found.information, Eigen::Matrix3d::Zero());
}

}  // namespace
}  // namespace core::closure
