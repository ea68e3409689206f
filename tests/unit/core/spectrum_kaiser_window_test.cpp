#include "core/spectrum/kaiser_window.h"

#include <gtest/gtest.h>

#include <cmath>

namespace core {
namespace {

TEST(KaiserWindow, IsItsDefinition) {
  for (const double beta : {0.0, 1.0, 5.0, 8.6, 20.0, 60.0}) {
    for (int i = -10; i <= 10; ++i) {
      const double edge = 0.1 * i, inside = std::sqrt(std::max(0.0, 1.0 - edge * edge));
      const double expected = std::cyl_bessel_i(0.0, beta * inside) / std::cyl_bessel_i(0.0, beta);
      EXPECT_NEAR(kaiser_window(edge, beta), expected, 1e-13 * expected) << beta << " at " << edge;
    }
  }
}

}  // namespace
}  // namespace core
