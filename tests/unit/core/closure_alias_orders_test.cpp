#include "core/closure/observation/alias_orders.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace core::closure {
namespace {

constexpr double kRadians = 4.0;

// Sums of uncorrelated modes: power times shape shape^T, their shear that of their order.
struct Mode {
  Eigen::Vector3cd shape;
  double power = 0.0;
  int order = 0;
};

Eigen::MatrixXd products() {
  Eigen::MatrixXd out(3, 3);
  out << 2.0, 0.3, 0.1, 0.3, 1.5, -0.2, 0.1, -0.2, 1.0;
  return out;
}

AliasStrip strip_of(const std::vector<Mode>& modes) {
  AliasStrip out{0, 1, Eigen::MatrixXcd::Zero(3, 3), Eigen::MatrixXcd::Zero(3, 3)};
  for (const Mode& mode : modes) {
    const Eigen::MatrixXcd moved = mode.power * mode.shape * mode.shape.adjoint();
    out.moved += moved;
    out.sheared += mode.order * kRadians * products() * moved;
  }
  return out;
}

std::vector<AliasStrip> split(std::vector<AliasStrip> strips) {
  split_by_order(strips, products(), kRadians);
  return strips;
}

TEST(AliasOrders, MotionOfOrderZeroIsNotSplit) {
  EXPECT_TRUE(split({strip_of({{{1.0, 0.5, 0.2}, 90.0, 0}, {{1.0, -1.0, 0.3}, 30.0, 0}})}).front().split.empty());
}

TEST(AliasOrders, WhereOneModeFoldsTheWholeStripHasItsOrder) {
  const AliasStrip strip = split({strip_of({{{1.0, 0.5, 0.2}, 90.0, -1}})}).front();
  ASSERT_EQ(strip.split.size(), 1U);
  EXPECT_EQ(strip.split.front().order, -1);
  EXPECT_TRUE(strip.split.front().share.isIdentity());
}

TEST(AliasOrders, ModesOfDifferentOrdersAreSplitByTheirShapes) {
  const Mode plain{{1.0, 0.5, 0.2}, 60.0, 0}, folded{{1.0, {-0.8, 0.6}, 0.3}, 40.0, -1},
      twice{{0.2, {0.3, 0.3}, -1.0}, 30.0, 2};
  const AliasStrip strip = split({strip_of({plain, folded, twice})}).front();
  ASSERT_EQ(strip.split.size(), 2U);
  for (const AliasPart& part : strip.split) {
    for (const Mode& mode : {plain, folded, twice}) {
      const Eigen::Vector3cd expected = part.order == mode.order ? mode.shape : Eigen::Vector3cd(0.0, 0.0, 0.0);
      EXPECT_LT((part.share * mode.shape - expected).norm(), 1e-6) << part.order << " " << mode.order;
    }
  }
}

// A shear of half an order is none of a motion that the camera sees.
TEST(AliasOrders, AShearOfNoOrderIsLeft) {
  AliasStrip strip = strip_of({{{1.0, 0.5, 0.2}, 90.0, 1}});
  strip.sheared *= 0.5;
  EXPECT_TRUE(split({strip}).front().split.empty());
}

TEST(AliasOrders, AWeakShearIsNoEvidence) {
  EXPECT_TRUE(split({strip_of({{{1.0, 0.5, 0.2}, 0.2, 1}})}).front().split.empty());
}

// Regions without rows of their own: readout 0, or a point for each.
TEST(AliasOrders, RegionsWithoutAShearFieldAreNotSplit) {
  std::vector<AliasStrip> strips{strip_of({{{1.0, 0.5, 0.2}, 90.0, 1}})};
  strips.front().sheared.setZero();
  split_by_order(strips, Eigen::MatrixXd::Zero(3, 3), kRadians);
  EXPECT_TRUE(strips.front().split.empty());
}

TEST(AliasOrders, TheFlankOfAPeakHasItsSplit) {
  const AliasStrip flank = strip_of({{{1.0, 0.5, 0.2}, 0.4, -1}});
  const auto strips =
      split({strip_of({{{1.0, 0.5, 0.2}, 90.0, -1}}), flank, strip_of({{{1.0, 0.5, 0.2}, 9.0, 0}}), flank});
  ASSERT_EQ(strips[1].split.size(), 1U);
  EXPECT_EQ(strips[1].split.front().order, -1);
  EXPECT_TRUE(strips[2].split.empty());  // evidence against it
  EXPECT_TRUE(strips[3].split.empty());
}

}  // namespace
}  // namespace core::closure
