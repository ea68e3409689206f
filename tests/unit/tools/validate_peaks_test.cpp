#include "tools/validate/peaks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "core/simulation/presets.h"
#include "core/simulation/random_stream.h"
#include "tools/validate/peak_fit.h"

namespace tools {
namespace {

using core::simulation::make_paper_scene;
using core::simulation::Scene;

TEST(TaperedSpectrum, PutsALineIntoItsBinAndNowhereElse) {
  std::vector<double> line;
  for (int i = 0; i < 1023; ++i) line.push_back(std::cos(2.0 * std::numbers::pi * 12.5 * i / 100.0));
  const TaperedSpectrum spectrum(line, 100.0, 5);
  EXPECT_NEAR(spectrum.bin_hz, 100.0 / 1024.0, 1e-12);
  const auto at = [&](double f) {
    return spectrum.density[static_cast<std::size_t>(std::lround(f / spectrum.bin_hz))];
  };
  for (const double f : {5.0, 10.0, 15.0, 40.0}) EXPECT_LT(at(f), 1e-4 * at(12.5)) << f;
}

TEST(TaperedSpectrum, IsFlatForWhiteNoise) {
  core::simulation::RandomStream stream(1, "noise");
  std::vector<double> noise(16383);
  for (double& value : noise) value = stream.gaussian();
  const TaperedSpectrum spectrum(noise, 1.0, 8);
  double low = 0.0, high = 0.0;
  for (std::size_t k = 100; k < 4000; ++k) low += spectrum.density[k] / 3900.0;
  for (std::size_t k = 4100; k < 8000; ++k) high += spectrum.density[k] / 3900.0;
  EXPECT_NEAR(low / high, 1.0, 0.07);  // each to 1.6 %
}

TEST(PeakFit, FindsTheOscillatorThatMadeTheSpectrum) {
  TaperedSpectrum spectrum(std::vector<double>(8191, 0.0), 40.0, 1);
  spectrum.kernel_variance_hz2 = 0.0;
  for (std::size_t k = 0; k < spectrum.density.size(); ++k) {
    const double f = static_cast<double>(k) * spectrum.bin_hz, apart = 3.3 * 3.3 - f * f, loss = 2.0 * 0.017 * 3.3 * f;
    spectrum.density[k] = 42.0 / (apart * apart + loss * loss);
  }
  const PeakFit fit = fit_peak(spectrum, 0.5, 15.0);
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.frequency_hz, 3.3, 1e-6);
  EXPECT_NEAR(fit.damping_ratio, 0.017, 1e-6);
}

TEST(PeakFit, TakesNoMoreTapersThanThePeakBears) {
  EXPECT_EQ(taper_count(0.0001, 600.0), 1);
  EXPECT_EQ(taper_count(0.01657, 600.0), 6);  // mean square of 1 .. 6 is 15.2, 0.16 * 9.94^2 is 15.8
  EXPECT_EQ(taper_count(10.0, 600.0), 30);
}

TEST(CheckPeaks, PassesThePapersScene) {
  const PeakCheck check = check_peaks(8, 600.0);
  ASSERT_EQ(check.modes.size(), 6U);
  EXPECT_TRUE(check.passed());
  EXPECT_NEAR(check.modes[0].frequency_scatter_hz, 1.657 * std::sqrt(0.01 / (2.0 * std::numbers::pi * 1.657 * 600.0)),
              1e-9);
  for (const ModePeak& mode : check.modes) {
    EXPECT_EQ(mode.n_failed, 0);
    EXPECT_GT(mode.frequency.rms, 0.3);  // an estimator that is handed the answer would have none
  }
}

// Peaks half a percent off, and half again as wide, are found where they are.
TEST(CheckPeaks, SeesATruthThatIsNotTheDeclaredOne) {
  const Scene scene = make_paper_scene(1, 600.0);
  const PeakCheck shifted = check_peaks(
      scene,
      core::simulation::uniform_chain({1.657, 5.04, 8.14 * 1.005, 10.83, 12.93, 14.34}, std::vector<double>(6, 0.01)),
      4);
  EXPECT_FALSE(shifted.passed());
  EXPECT_LT(shifted.modes[2].frequency.mean, -5.0);
  const PeakCheck wider = check_peaks(
      scene,
      core::simulation::uniform_chain({1.657, 5.04, 8.14, 10.83, 12.93, 14.34}, {0.01, 0.01, 0.01, 0.015, 0.01, 0.01}),
      4);
  EXPECT_FALSE(wider.passed());
  EXPECT_LT(wider.modes[3].damping.mean, -3.0);
  EXPECT_LT(std::abs(wider.modes[3].frequency.mean), 2.0);
}

TEST(CheckPeaks, RefusesRecordsThatCannotShowThePeaks) {
  EXPECT_THROW((void)check_peaks(4, 60.0), std::invalid_argument);
  EXPECT_THROW((void)check_peaks(0, 600.0), std::invalid_argument);
}

}  // namespace
}  // namespace tools
