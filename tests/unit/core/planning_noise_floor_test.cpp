#include "core/planning/noise_floor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace core::planning {
namespace {

TEST(NoiseFloor, PointNoiseIsTheBoundTimesTheTrackersExcess) {
  // sqrt(4 + 1/12) / (8 * 21) = 0.012028; twice that with OpenCV's tracker
  EXPECT_NEAR(point_sigma_px({2.0, 8.0, 21.0, 1.0}), 0.012028, 1e-6);
  EXPECT_NEAR(point_sigma_px({}), 0.024056, 1e-6);
  // Without noise the rounding to grey levels remains.
  EXPECT_NEAR(point_sigma_px({0.0, 10.0, 20.0, 1.0}), std::sqrt(1.0 / 12.0) / 200.0, 1e-12);
}

TEST(NoiseFloor, DefaultTextureLiesBetween002And003PxPerPoint) {
  EXPECT_GT(point_sigma_px({}), 0.02);
  EXPECT_LT(point_sigma_px({}), 0.03);
}

TEST(NoiseFloor, RefusesTextureWithoutGradientAndNotANumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)point_sigma_px({2.0, 0.0, 21.0, 1.0}), std::invalid_argument);
  EXPECT_THROW((void)point_sigma_px({nan, 8.0, 21.0, 1.0}), std::invalid_argument);
  EXPECT_THROW((void)point_sigma_px({2.0, 8.0, 21.0, 0.5}), std::invalid_argument);
}

TEST(NoiseFloor, PointsThatShareTheirPixelsCountOnce) {
  EXPECT_DOUBLE_EQ(independent_points(30, 0.0, 0.0, 21.0), 30.0);   // unknown region
  EXPECT_DOUBLE_EQ(independent_points(30, 21.0, 21.0, 21.0), 4.0);  // 42 x 42 px hold four patches
  EXPECT_DOUBLE_EQ(independent_points(3, 500.0, 500.0, 21.0), 3.0);
  EXPECT_GE(independent_points(5, 0.1, 0.1, 21.0), 1.0);
}

TEST(NoiseFloor, ChannelAndDensityByHand) {
  // 0.03 px, 36 points, 2 mm/px: 0.01 mm; at 50 Hz 0.01 * sqrt(2 / 50) = 0.002 mm/sqrt(Hz)
  const NoiseFloor floor = noise_floor(0.03, 36.0, 2.0, 50.0);
  EXPECT_NEAR(floor.channel_sigma_mm, 0.01, 1e-15);
  EXPECT_NEAR(floor.density_mm_per_sqrt_hz, 0.002, 1e-15);
  // Over the band 0 .. f_s / 2 the density is the variance again.
  EXPECT_NEAR(floor.density_mm_per_sqrt_hz * floor.density_mm_per_sqrt_hz * 25.0, 1e-4, 1e-15);
}

TEST(NoiseFloor, ExposureLeavesASinc) {
  EXPECT_DOUBLE_EQ(exposure_gain(10.0, 0.0), 1.0);
  EXPECT_NEAR(exposure_gain(10.0, 0.05), 2.0 / std::numbers::pi, 1e-12);  // half a period
  EXPECT_NEAR(exposure_gain(10.0, 0.1), 0.0, 1e-12);                      // a whole one
  EXPECT_NEAR(exposure_gain(10.0, 0.15), 2.0 / (3.0 * std::numbers::pi), 1e-12);
}

// The resonance's density integrates to the rms that was put in.
TEST(NoiseFloor, PeakBelongsToAResonanceOfThatRms) {
  const double f0 = 3.0, zeta = 0.01, rms = 0.5;
  const double peak = peak_density(rms, zeta, f0, 0.0);
  double variance = 0.0;
  const double step = 1e-4;
  for (double f = 0.5 * step; f < 50.0; f += step) {
    const double r = f / f0;
    const double shape = std::pow(2.0 * zeta, 2) / (std::pow(1.0 - r * r, 2) + std::pow(2.0 * zeta * r, 2));
    variance += peak * shape * step;
  }
  EXPECT_NEAR(std::sqrt(variance), rms, 1e-3 * rms);
}

TEST(NoiseFloor, LeastAmplitudeStandsTheRatioOverTheFloor) {
  const double density = 1e-3, gain = 0.8;
  const double rms = least_rms_mm(10.0, density, 0.01, 5.0, 0.07, gain);
  EXPECT_NEAR(peak_density(rms * gain, 0.01, 5.0, 0.07) / (density * density), 10.0, 1e-9);
  EXPECT_TRUE(std::isinf(least_rms_mm(10.0, density, 0.01, 5.0, 0.07, 0.0)));
}

}  // namespace
}  // namespace core::planning
