#include "core/simulation/structure/periodic_signal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "core/simulation/random_stream.h"

namespace core::simulation {
namespace {

constexpr double kPeriod_s = 10.0;

double direct_sum(const std::vector<std::complex<double>>& amplitude, double t_s) {
  double sum = 0.0;
  for (std::size_t k = 0; k < amplitude.size(); ++k) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) * t_s / kPeriod_s;
    sum += std::real(amplitude[k] * std::polar(1.0, angle));
  }
  return sum;
}

TEST(PeriodicSignal, MatchesTheSumOfItsHarmonicsAtAnyTime) {
  RandomStream stream(1, "test");
  std::vector<std::complex<double>> amplitude(100);  // up to 9.9 Hz
  double power = 0.0;
  for (auto& a : amplitude) {
    a = {stream.gaussian(), stream.gaussian()};
    power += 0.5 * std::norm(a);
  }
  const PeriodicSignal signal(amplitude, kPeriod_s, 2048);  // 204.8 Hz: 20 samples per cycle of the fastest
  for (int i = 0; i < 500; ++i) {
    const double t_s = 40.0 * stream.uniform() - 20.0;  // before and beyond the period too
    EXPECT_NEAR(signal.at(t_s), direct_sum(amplitude, t_s), 1e-5 * std::sqrt(power));
  }
}

TEST(PeriodicSignal, MeetsItsStatedErrorAtTenSamplesPerCycle) {
  std::vector<std::complex<double>> amplitude(103);
  amplitude[102] = 1.0;
  const PeriodicSignal signal(amplitude, kPeriod_s, 1024);
  double worst = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const double t_s = 1e-3 * i;
    worst = std::max(worst, std::abs(signal.at(t_s) - direct_sum(amplitude, t_s)));
  }
  EXPECT_LT(worst, 3.5e-4);
  EXPECT_GT(worst, 1e-5);  // the formula is an estimate and does not exceed the error by much
}

TEST(PeriodicSignal, ComputesTheRmsOverASpan) {
  std::vector<std::complex<double>> amplitude(6);
  amplitude[5] = 3.0;
  const PeriodicSignal signal(amplitude, kPeriod_s, 1024);
  EXPECT_NEAR(signal.rms(0.0, kPeriod_s), 3.0 / std::numbers::sqrt2, 1e-9);
}

TEST(PeriodicSignal, IsZeroWhenEmpty) { EXPECT_EQ(PeriodicSignal().at(1.0), 0.0); }

TEST(PeriodicSignal, RefusesAGridTooCoarseForItsHarmonics) {
  EXPECT_THROW(PeriodicSignal(std::vector<std::complex<double>>(100), kPeriod_s, 128), std::invalid_argument);
  EXPECT_THROW((void)grid_size(1e9, 200.0), std::invalid_argument);
}

}  // namespace
}  // namespace core::simulation
