#include "core/identification/real_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/identification/mac.h"

namespace core {
namespace {

using Shape = std::vector<std::complex<double>>;

TEST(RealShape, AShapeOfOnePhaseIsItselfWithTheLargestComponentPositive) {
  const std::vector<double> truth{0.0, 0.5, -0.25, -1.0};
  Shape turned;
  for (const double x : truth) turned.push_back(x * std::polar(3.0, 1.1));
  const std::vector<double> real = real_shape(turned);
  for (std::size_t i = 0; i < truth.size(); ++i) EXPECT_NEAR(real[i], -3.0 * truth[i], 1e-12) << i;
}

// With a rolling shutter: phases over a range of 1.6 radians reduce the complex MAC, but not the real one.
TEST(RealShape, DelaysTurnComponentsAndLeaveTheirMagnitudes) {
  const std::vector<double> truth{1.0, -0.3, -1.0, -0.4, 0.7, 1.0};
  Shape delayed, real;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    delayed.push_back(truth[i] * std::polar(1.0, 1.6 * static_cast<double>(i) / 5.0));
    real.emplace_back(truth[i]);
  }
  EXPECT_LT(mac(delayed, real), 0.95);
  EXPECT_NEAR(real_mac(delayed, real), 1.0, 1e-12);
}

TEST(RealShape, SignsCount) {
  const Shape a{1.0, 1.0}, b{1.0, -1.0};
  EXPECT_NEAR(real_mac(a, b), 0.0, 1e-12);
  EXPECT_EQ(real_mac(a, Shape{0.0, 0.0}), 0.0);
  EXPECT_TRUE(real_shape(Shape{}).empty());
}

}  // namespace
}  // namespace core
