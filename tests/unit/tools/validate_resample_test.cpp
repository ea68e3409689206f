#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tools/validate/resample.h"

namespace {

std::vector<double> sine(double frequency_hz, double rate_hz, double duration_s) {
  std::vector<double> out;
  for (int k = 0; k < static_cast<int>(duration_s * rate_hz); ++k) {
    out.push_back(std::sin(2.0 * std::numbers::pi * frequency_hz * k / rate_hz));
  }
  return out;
}

double worst_error(double frequency_hz) {
  const std::vector<double> out = tools::resampled(sine(frequency_hz, 60.0, 20.0), 60.0, 25.0);
  double worst = 0.0;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double t_s = tools::kResamplingEdge_s + static_cast<double>(k) / 25.0;
    worst = std::max(worst, std::abs(out[k] - std::sin(2.0 * std::numbers::pi * frequency_hz * t_s)));
  }
  return worst;
}

TEST(Resampled, KeepsWhatTheNewRateHolds) {
  for (const double frequency_hz : {0.3, 1.657, 5.04, 8.14}) EXPECT_LT(worst_error(frequency_hz), 0.01) << frequency_hz;
}

TEST(Resampled, TakesAwayWhatWouldFold) {
  const std::vector<double> out = tools::resampled(sine(14.34, 60.0, 20.0), 60.0, 25.0);
  for (const double value : out) EXPECT_LT(std::abs(value), 0.02);
}

TEST(Resampled, LeavesOutTheEdges) {
  const std::vector<double> out = tools::resampled(std::vector<double>(600, 3.0), 60.0, 25.0);
  EXPECT_NEAR(static_cast<double>(out.size()), 9.0 * 25.0, 1.0);
  for (const double value : out) EXPECT_NEAR(value, 3.0, 1e-12);
  EXPECT_TRUE(tools::resampled(std::vector<double>(30, 1.0), 60.0, 25.0).empty()) << "shorter than the edges";
}

}  // namespace
