#include "core/closure/response/clock_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/closure/closure_loop.h"
#include "core/closure/noise_stream.h"
#include "core/closure/response/response_level.h"

namespace core::closure {
namespace {

using ::testing::HasSubstr;

constexpr std::size_t kFrames = 600;
constexpr double kScatter_s = 0.01;

// A clock that is read with noise; `lost` frames are missing before frame 300.
ClockReadings filmed(double true_rate_hz, std::uint64_t seed, double lost = 0.0) {
  NoiseStream noise(seed);
  ClockReadings out;
  for (std::size_t k = 0; k < kFrames; ++k) {
    const double frame = static_cast<double>(k);
    out.frame.push_back(frame);
    out.reading_s.push_back(12.3 + (frame + (k >= 300 ? lost : 0.0)) / true_rate_hz + kScatter_s * noise.gaussian());
  }
  return out;
}

ClosureResult close(const ClockModel& model) {
  ResponseLevel level(model);
  ClosureOptions options;
  options.n_surrogates = 64;
  return close_loop(level, options);
}

TEST(ClockModel, WrongDeclaredRateIsFoundFromTheFilmedClock) {
  const ClockModel model(filmed(22.67, 1), {20.0});
  const ClosureResult result = close(model);
  ASSERT_EQ(result.steps.size(), 1U);
  EXPECT_EQ(result.steps[0].effect, "clock_rate");
  EXPECT_TRUE(result.steps[0].rivals.empty());
  const ParameterValue& rate = result.steps[0].parameters.at(0);
  ASSERT_TRUE(rate.sigma);
  EXPECT_NEAR(rate.value, 22.67, 4.0 * *rate.sigma);
  EXPECT_LT(*rate.sigma, 0.01);
  EXPECT_GT(result.steps[0].heldout_before, 500.0);
  EXPECT_NEAR(result.steps[0].heldout_after, 10.0, 1.0);
  const auto times = model.frame_times_s({"clock_rate"}, kFrames);
  EXPECT_NEAR(times.back(), (kFrames - 1) / 22.67, 0.005);
}

TEST(ClockModel, RightRateLeavesNothingToAdopt) {
  int adopted = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    adopted += close(ClockModel(filmed(20.0, seed), {20.0})).steps.empty() ? 0 : 1;
  EXPECT_EQ(adopted, 0);
}

TEST(ClockModel, MisreadReadingsTakeNoPart) {
  ClockReadings readings = filmed(22.67, 3);
  for (std::size_t k = 5; k < kFrames; k += 60) readings.reading_s[k] += 1.0;
  readings.reading_s[100] = std::numeric_limits<double>::quiet_NaN();
  const ClockModel model(readings, {20.0});
  EXPECT_EQ(model.n_misread(), 10U);
  EXPECT_NEAR(close(model).steps.at(0).heldout_after, 10.0, 1.0);
}

void expect_refusal(const ClockReadings& readings, const DeclaredTime& declared, const std::string& words) {
  try {
    const ClockModel model(readings, declared);
    FAIL() << "taken for a clock: " << words;
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr(words));
  }
}

TEST(ClockModel, RefusesWhatIsNoClockInWords) {
  ClockReadings backward = filmed(20.0, 1);
  for (double& reading : backward.reading_s) reading = 100.0 - reading;
  expect_refusal(backward, {20.0}, "runs backward");
  ClockReadings few = filmed(20.0, 1);
  few.frame.resize(10);
  few.reading_s.resize(10);
  expect_refusal(few, {20.0}, "10 readings are too few");
  ClockReadings unordered = filmed(20.0, 1);
  unordered.frame[7] = 3.0;
  expect_refusal(unordered, {20.0}, "ascend");
  ClockReadings nothing = filmed(20.0, 1);
  for (double& reading : nothing.reading_s) reading = std::numeric_limits<double>::quiet_NaN();
  expect_refusal(nothing, {20.0}, "too few");
  expect_refusal(filmed(20.0, 1), {0.0}, "rate");
}

}  // namespace
}  // namespace core::closure
