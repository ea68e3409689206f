#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "core/closure/closure_loop.h"
#include "core/closure/noise_stream.h"
#include "core/closure/response/free_decay_model.h"
#include "core/closure/response/response_level.h"

namespace core::closure {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kRate_hz = 25.0, kTwoPi = 2.0 * std::numbers::pi;
constexpr int kReleases = 5, kPull = 25, kDecay = 45;

// An oscillator with a cubic spring (`cubic`: share of stiffness lost at 100 units), displaced and released; two
// floors, the lower one at 0.5. Integrated with a thousand steps a second.
std::vector<std::vector<double>> pulled_and_released(double cubic, double noise_rms, std::uint64_t seed) {
  NoiseStream noise(seed);
  std::vector<double> roof;
  for (int r = 0; r < kReleases; ++r) {
    const double pull = -(70.0 + 10.0 * r);
    for (int k = 0; k < kPull; ++k) roof.push_back(pull * std::min(1.0, k / 15.0));
    double x = pull, v = 0.0;
    const double w = kTwoPi * 4.0, h = 1e-4;
    for (int k = 0; k < kDecay; ++k) {
      for (int i = 0; i < 400; ++i) {
        v += h * (-2.0 * 0.03 * w * v - w * w * (1.0 - cubic * x * x / 1e4) * x);
        x += h * v;
      }
      roof.push_back(x);
    }
  }
  std::vector<std::vector<double>> out(2);
  for (const double x : roof) {
    out[0].push_back(x + noise_rms * noise.gaussian());
    out[1].push_back(0.5 * x + noise_rms * noise.gaussian());
  }
  return out;
}

ClosureResult close(double cubic, std::uint64_t seed) {
  const FreeDecayModel model(
      find_free_decays(pulled_and_released(cubic, 0.1, seed), kRate_hz, {"roof", "floor"}, "px"));
  ResponseLevel level(model);
  ClosureOptions options;
  options.n_surrogates = 16;
  return close_loop(level, options);
}

TEST(FreeDecays, EveryReleaseIsFoundWhereTheStructureCrossesItsRest) {
  const FreeDecays decays = find_free_decays(pulled_and_released(0.0, 0.05, 1), kRate_hz, {"roof", "floor"}, "px");
  ASSERT_EQ(decays.release.size(), static_cast<std::size_t>(kReleases));
  for (std::size_t r = 0; r < decays.start.size(); ++r)
    EXPECT_NEAR(static_cast<double>(decays.start[r]),
                static_cast<double>(kPull + static_cast<int>(r) * (kPull + kDecay)) + 1.0, 2.0);
}

TEST(FreeDecays, SofteningSpringIsTracedToItsAmplitudeOnReleasesThatTheFitDidNotSee) {
  const ClosureResult result = close(0.25, 1);
  ASSERT_FALSE(result.steps.empty());
  EXPECT_EQ(result.steps.front().effect, "amplitude_dependent_frequency");
  ASSERT_TRUE(result.reference_error_after);
  EXPECT_LT(*result.reference_error_after, *result.reference_error_before / 3.0);
  ASSERT_EQ(result.modes_after.size(), 1U);
  // A parabola in ln a cannot represent a cubic spring's a^2 law over the whole decay: the frequency at one amplitude
  // is biased.
  EXPECT_NEAR(result.modes_after[0].frequency_hz, 4.0, 0.2);
}

TEST(FreeDecays, LinearStructureLeavesNothing) {
  const ClosureResult result = close(0.0, 2);
  EXPECT_TRUE(result.steps.empty()) << result.steps.front().effect;
  EXPECT_NEAR(result.residual_rms, 0.1, 0.02);
  ASSERT_EQ(result.modes_before.size(), 1U);
  EXPECT_NEAR(result.modes_before[0].frequency_hz, 4.0, 0.01);
  EXPECT_NEAR(result.modes_before[0].damping_ratio.value_or(0.0), 0.03, 0.002);
}

TEST(FreeDecays, TooFewReleasesAreRefusedInWords) {
  std::vector<std::vector<double>> quiet(2, std::vector<double>(500, 1.0));
  quiet[0][3] = 1.5;
  try {
    (void)find_free_decays(quiet, kRate_hz, {"roof", "floor"}, "px");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("three or more"));
  }
  for (double& v : quiet[0]) v = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)find_free_decays(quiet, kRate_hz, {"roof", "floor"}, "px"), std::invalid_argument);
  quiet[1].pop_back();
  EXPECT_THROW((void)find_free_decays(quiet, kRate_hz, {"roof", "floor"}, "px"), std::invalid_argument);
  EXPECT_THROW((void)find_free_decays({}, kRate_hz, {}, "px"), std::invalid_argument);
}

}  // namespace
}  // namespace core::closure
