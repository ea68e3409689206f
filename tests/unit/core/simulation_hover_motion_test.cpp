#include "core/simulation/hover_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace core::simulation {
namespace {

TEST(HoverMotion, Holds98PercentOfItsVarianceBelowHalfAHertz) {
  constexpr double kDuration_s = 200.0, kRate_hz = 10.0;
  double low = 0.0, all = 0.0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const HoverMotion hover({}, seed, kDuration_s);
    std::vector<double> x;
    for (int i = 0; i < static_cast<int>(kDuration_s * kRate_hz); ++i) {
      x.push_back(hover.at(i / kRate_hz).x_mm * std::sin(std::numbers::pi * i / (kDuration_s * kRate_hz)));
    }
    for (int k = 0; k < static_cast<int>(x.size()) / 2; ++k) {
      std::complex<double> sum = 0.0;
      const std::complex<double> turn = std::polar(1.0, -2.0 * std::numbers::pi * k / static_cast<double>(x.size()));
      std::complex<double> phase = 1.0;
      for (const double value : x) sum += value * phase, phase *= turn;
      all += std::norm(sum);
      if (k / kDuration_s < 0.5) low += std::norm(sum);
    }
  }
  EXPECT_NEAR(low / all, 0.98, 0.008);
}

TEST(HoverMotion, HasTheDeclaredSpreadOnEveryAxis) {
  double x = 0.0, y = 0.0, z = 0.0;
  constexpr int kSeeds = 20;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto rms = HoverMotion({}, seed, 100.0).rms();
    x += rms[0] * rms[0], y += rms[1] * rms[1], z += rms[2] * rms[2];
    EXPECT_EQ(rms[3], 0.0);
  }
  EXPECT_NEAR(std::sqrt(x / kSeeds), 25.0, 2.0);
  EXPECT_NEAR(std::sqrt(y / kSeeds), 8.0, 0.7);
  EXPECT_NEAR(std::sqrt(z / kSeeds), 25.0, 2.0);
}

TEST(HoverMotion, KeepsTheOtherAxesWhenOneIsSwitchedOff) {
  HoverParameters quiet;
  quiet.x_rms_mm = 0.0;
  quiet.roll_rms_rad = 0.01;
  const CameraPose a = HoverMotion({}, 1, 30.0).at(7.3), b = HoverMotion(quiet, 1, 30.0).at(7.3);
  EXPECT_EQ(b.x_mm, 0.0);
  EXPECT_EQ(a.y_mm, b.y_mm);
  EXPECT_EQ(a.z_mm, b.z_mm);
  EXPECT_TRUE(a.attitude.isIdentity());
  EXPECT_FALSE(b.attitude.isIdentity());
}

}  // namespace
}  // namespace core::simulation
