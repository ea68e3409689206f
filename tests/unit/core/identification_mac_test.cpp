#include "core/identification/mac.h"

#include <gtest/gtest.h>

#include <vector>

namespace core {
namespace {

using Shape = std::vector<std::complex<double>>;

TEST(Mac, IsOneForAnyComplexMultiple) {
  const Shape a{{1.0, 0.2}, {0.5, -0.1}, {-0.3, 0.0}};
  Shape b = a;
  for (auto& z : b) z *= std::complex<double>(-2.0, 3.0);
  EXPECT_NEAR(mac(a, b), 1.0, 1e-15);
}

TEST(Mac, IsZeroForOrthogonalAndForZeroShapes) {
  EXPECT_EQ(mac(Shape{1.0, 1.0}, Shape{1.0, -1.0}), 0.0);
  EXPECT_EQ(mac(Shape{0.0, 0.0}, Shape{1.0, -1.0}), 0.0);
  EXPECT_EQ(mac(Shape{}, Shape{}), 0.0);
}

TEST(Mac, IsTheSquaredCosine) { EXPECT_NEAR(mac(Shape{1.0, 0.0}, Shape{1.0, 1.0}), 0.5, 1e-15); }

TEST(Mpc, IsOneOnALineThroughTheOriginAtAnyAngle) {
  Shape shape{1.0, -0.4, 0.7};
  EXPECT_NEAR(mpc(shape), 1.0, 1e-15);
  for (auto& z : shape) z *= std::polar(2.0, 0.9);
  EXPECT_NEAR(mpc(shape), 1.0, 1e-15);
}

TEST(Mpc, IsZeroForATravellingWave) {
  EXPECT_NEAR(mpc(Shape{{1.0, 0.0}, {0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}}), 0.0, 1e-15);
  EXPECT_EQ(mpc(Shape{0.0, 0.0}), 0.0);
}

}  // namespace
}  // namespace core
