#include "core/planning/ideal_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/planning/hover_plan.h"
#include "core/simulation/structure/structure_model.h"

namespace core::planning {
namespace {

TEST(IdealShape, ShearChainIsTheSimulatorsChain) {
  const int n = 6;
  const auto truth = simulation::shear_chain_shapes(n);
  for (int mode = 1; mode <= n; ++mode) {
    const auto shape = ideal_shape(StructureKind::kShearChain, mode, even_positions(StructureKind::kShearChain, n), n);
    for (int floor = 0; floor < n; ++floor) {
      EXPECT_NEAR(shape[static_cast<std::size_t>(floor)], truth(floor, mode - 1), 1e-12) << mode << ' ' << floor;
    }
  }
}

TEST(IdealShape, CantileverHasItsTextbookNodes) {
  // Blevins: nodes at x / L = 0.7834; 0.5035, 0.8677; 0.3583, 0.6442, 0.9056
  const struct {
    int mode;
    std::vector<double> nodes;
  } cases[] = {{2, {0.7834}}, {3, {0.5035, 0.8677}}, {4, {0.3583, 0.6442, 0.9056}}};
  for (const auto& c : cases) {
    std::vector<double> positions = c.nodes;
    positions.push_back(1.0);
    const auto shape = ideal_shape(StructureKind::kCantilever, c.mode, positions, 1);
    EXPECT_DOUBLE_EQ(shape.back(), 1.0);
    for (std::size_t i = 0; i < c.nodes.size(); ++i) EXPECT_NEAR(shape[i], 0.0, 2e-3) << c.mode << ' ' << c.nodes[i];
  }
}

TEST(IdealShape, CantileverStaysFiniteAndFreeAtItsTopInHighModes) {
  for (int mode = 1; mode <= 40; ++mode) {
    const auto shape = ideal_shape(StructureKind::kCantilever, mode, {0.0, 0.25, 0.5, 0.75, 1.0}, 1);
    for (const double value : shape) EXPECT_LE(std::abs(value), 1.0);
    EXPECT_NEAR(shape.front(), 0.0, 1e-9) << mode;
    EXPECT_NEAR(std::abs(shape.back()), 1.0, 1e-9) << mode;  // the tip moves most
  }
}

TEST(IdealShape, BeamIsASine) {
  const auto shape = ideal_shape(StructureKind::kBeam, 2, {0.0, 0.25, 0.5, 0.75, 1.0}, 1);
  const double expected[] = {0.0, 1.0, 0.0, -1.0, 0.0};
  for (std::size_t i = 0; i < shape.size(); ++i) EXPECT_NEAR(shape[i], expected[i], 1e-12);
}

TEST(IdealShape, RefusesModesThatDoNotExist) {
  EXPECT_THROW((void)ideal_shape(StructureKind::kShearChain, 4, {1.0}, 3), std::invalid_argument);
  EXPECT_THROW((void)ideal_shape(StructureKind::kBeam, 0, {0.5}, 1), std::invalid_argument);
  EXPECT_THROW((void)ideal_shape(StructureKind::kBeam, 1, {1.5}, 1), std::invalid_argument);
  EXPECT_THROW((void)ideal_shape(StructureKind::kBeam, 1, {std::numeric_limits<double>::quiet_NaN()}, 1),
               std::invalid_argument);
}

}  // namespace
}  // namespace core::planning
