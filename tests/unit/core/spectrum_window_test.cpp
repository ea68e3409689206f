#include "core/spectrum/window.h"

#include <gtest/gtest.h>

namespace core {
namespace {

TEST(Window, HannIsPeriodic) {
  const std::vector<double> w = make_window(WindowKind::kHann, 8);
  const std::vector<double> expected{0.0, 0.14644660940672624, 0.5, 0.8535533905932737,
                                     1.0, 0.8535533905932737,  0.5, 0.14644660940672624};
  ASSERT_EQ(w.size(), 8U);
  for (std::size_t t = 0; t < 8; ++t) EXPECT_NEAR(w[t], expected[t], 1e-15);
}

TEST(Window, HammingStandsOnAPedestal) {
  const std::vector<double> w = make_window(WindowKind::kHamming, 6);
  EXPECT_NEAR(w[0], 0.08, 1e-15);
  EXPECT_NEAR(w[3], 1.0, 1e-15);
  EXPECT_NEAR(w[1], w[5], 1e-15);
}

TEST(Window, BoxcarIsOnes) { EXPECT_EQ(make_window(WindowKind::kBoxcar, 5), std::vector<double>(5, 1.0)); }

TEST(Window, IsKnownByName) {
  EXPECT_EQ(window_kind("hann"), WindowKind::kHann);
  EXPECT_EQ(window_kind("hamming"), WindowKind::kHamming);
  EXPECT_EQ(window_kind("boxcar"), WindowKind::kBoxcar);
  EXPECT_EQ(window_kind("Hann"), std::nullopt);
  EXPECT_EQ(window_kind(""), std::nullopt);
}

}  // namespace
}  // namespace core
