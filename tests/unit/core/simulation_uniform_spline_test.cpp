#include "core/simulation/camera/uniform_spline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace core::simulation {
namespace {

constexpr double kRate = 10.0;

std::vector<double> sine(double samples_per_cycle, int n, double phase = 0.3) {
  std::vector<double> out;
  for (int k = 0; k < n; ++k) out.push_back(std::sin(2.0 * std::numbers::pi * k / samples_per_cycle + phase));
  return out;
}

TEST(UniformSpline, GoesThroughEverySample) {
  const std::vector<double> samples{3.0, -1.0, 4.0, 1.0, -5.0, 9.0, 2.0};
  const UniformSpline spline(samples, kRate);
  for (std::size_t k = 0; k < samples.size(); ++k)
    EXPECT_NEAR(spline.at(static_cast<double>(k) / kRate), samples[k], 1e-12) << k;
}

// The header's figures, away from the ends.
TEST(UniformSpline, MeetsASineToTheStatedError) {
  const struct {
    double samples_per_cycle, error;
  } cases[] = {{4.0, 0.025}, {8.0, 1.2e-3}, {16.0, 6.5e-5}, {20.0, 2.6e-5}};
  for (const auto& c : cases) {
    const UniformSpline spline(sine(c.samples_per_cycle, 400), kRate);
    double worst = 0.0;
    for (double position = 40.0; position < 360.0; position += 0.037) {
      const double truth = std::sin(2.0 * std::numbers::pi * position / c.samples_per_cycle + 0.3);
      worst = std::max(worst, std::abs(spline.at(position / kRate) - truth));
    }
    EXPECT_LT(worst, c.error) << c.samples_per_cycle;
    EXPECT_GT(worst, 0.5 * c.error) << c.samples_per_cycle;
  }
}

TEST(UniformSpline, EndsCostNoMoreThanStated) {
  for (const double n : {8.0, 20.0}) {
    for (double phase = 0.0; phase < 6.0; phase += 0.4) {
      const UniformSpline spline(sine(n, 200, phase), kRate);
      for (double position = 0.0; position < 2.0; position += 0.05) {
        const double truth = std::sin(2.0 * std::numbers::pi * position / n + phase);
        EXPECT_LT(std::abs(spline.at(position / kRate) - truth), 0.2 * 2.0 * std::numbers::pi / n);
      }
    }
  }
}

TEST(UniformSpline, RunsBackAndForthBeyondItsEnds) {
  const std::vector<double> samples = sine(7.3, 50);
  const UniformSpline spline(samples, kRate);
  const double end = 49.0 / kRate;
  for (double t = 0.01; t < 4.8; t += 0.173) {
    EXPECT_NEAR(spline.at(-t), spline.at(t), 1e-12);
    EXPECT_NEAR(spline.at(end + t), spline.at(end - t), 1e-12);
    EXPECT_NEAR(spline.at(t + 20.0 * end), spline.at(t), 1e-9);
  }
}

TEST(UniformSpline, PositionAndVelocityAreContinuousEverywhere) {
  const UniformSpline spline(sine(5.0, 30), kRate);
  const double step = 1e-4;
  double last = 0.0;
  for (double t = -4.0; t < 8.0; t += step) {
    const double velocity = (spline.at(t + step) - spline.at(t)) / step;
    if (t > -4.0 + step) {
      EXPECT_LT(std::abs(velocity - last), 0.5) << t;  // a kink would be several units per second
    }
    last = velocity;
  }
}

TEST(UniformSpline, ShortRecordsAndBadTimesAreHarmless) {
  const UniformSpline spline({1.0, 2.0, 3.0, 5.0}, kRate);
  EXPECT_NEAR(spline.at(0.3), 5.0, 1e-12);
  EXPECT_EQ(spline.at(std::numeric_limits<double>::quiet_NaN()), 0.0);
  EXPECT_EQ(spline.at(std::numeric_limits<double>::infinity()), 0.0);
  EXPECT_TRUE(std::isfinite(spline.at(1e300)));
  EXPECT_EQ(UniformSpline().at(1.0), 0.0);
  EXPECT_THROW(UniformSpline({1.0, 2.0, 3.0}, kRate), std::invalid_argument);
  EXPECT_THROW(UniformSpline({1.0, 2.0, 3.0, 4.0}, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace core::simulation
