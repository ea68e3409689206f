#include "core/closure/response/logger_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "core/closure/closure_loop.h"
#include "core/closure/noise_stream.h"
#include "core/closure/response/response_level.h"

namespace core::closure {
namespace {

using ::testing::HasSubstr;

constexpr double kRate_hz = 100.0;

// Three modes under white forces, recorded by three loggers whose samples come `late` samples after the first one's.
LoggerRecords recorded(const std::vector<double>& late, std::uint64_t seed, bool third_inverted = false) {
  constexpr double kHz[3] = {2.1, 6.3, 10.4};
  constexpr double kShape[3][3] = {{0.4, 0.8, 1.0}, {1.0, 0.4, -0.8}, {-0.7, 1.0, -0.5}};
  constexpr int kFine = 20, kN = 3000;
  NoiseStream noise(seed);
  double x[3] = {}, v[3] = {};
  std::vector<double> fine[3];
  for (int k = 0; k < (kN + 200) * kFine; ++k) {
    const double force[3] = {noise.gaussian(), noise.gaussian(), noise.gaussian()};
    double seen[3] = {};
    for (int m = 0; m < 3; ++m) {
      const double w = 2.0 * std::numbers::pi * kHz[m], h = 1.0 / (kRate_hz * kFine);
      double load = 0.0;
      for (int c = 0; c < 3; ++c) load += kShape[m][c] * force[c];
      v[m] += h * (-2.0 * 0.01 * w * v[m] - w * w * x[m] + w * load);
      x[m] += h * v[m];
      for (int c = 0; c < 3; ++c) seen[c] += kShape[m][c] * w * w * x[m];
    }
    for (int c = 0; c < 3; ++c) fine[c].push_back(seen[c]);
  }
  LoggerRecords out;
  out.rate_hz = kRate_hz;
  for (std::size_t c = 0; c < 3; ++c) {
    out.name.push_back("logger" + std::to_string(c + 1));
    std::vector<double> own;
    for (int k = 0; k < kN; ++k) {
      const double at = (k + 100 + late[c]) * kFine;
      const double value = fine[c][static_cast<std::size_t>(std::lround(at))];
      own.push_back((third_inverted && c == 2 ? -value : value) + 0.001 * noise.gaussian());
    }
    out.value.push_back(std::move(own));
  }
  return out;
}

ClosureResult close(const LoggerModel& model) {
  ResponseLevel level(model);
  ClosureOptions options;
  options.n_surrogates = 48;
  return close_loop(level, options);
}

TEST(LoggerModel, OffsetsBetweenUnsynchronisedLoggersAreFoundWithTheirSigma) {
  const LoggerModel model(recorded({0.0, 17.3, -42.6}, 1));
  const ClosureResult result = close(model);
  ASSERT_FALSE(result.steps.empty());
  EXPECT_EQ(result.steps[0].effect, "clock_offset");
  const auto& found = result.steps[0].parameters;
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].value, 173.0, 2.0);
  EXPECT_NEAR(found[1].value, -426.0, 2.0);
  ASSERT_TRUE(found[0].sigma);
  EXPECT_LT(*found[0].sigma, 2.0);
  EXPECT_NEAR(model.offsets_s({"clock_offset"})[1], 0.173, 0.002);
}

TEST(LoggerModel, InvertedLoggerDoesNotDisturbTheOffsets) {
  const LoggerModel model(recorded({0.0, 5.0, 9.0}, 2, true));
  const std::vector<double> offsets = model.offsets_s({"clock_offset"});
  EXPECT_NEAR(offsets[1], 0.05, 0.002);
  EXPECT_NEAR(offsets[2], 0.09, 0.002);
}

TEST(LoggerModel, SynchronisedLoggersHaveNoOffset) {
  int adopted = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    adopted += close(LoggerModel(recorded({0.0, 0.0, 0.0}, seed))).steps.empty() ? 0 : 1;
  EXPECT_EQ(adopted, 0);
}

TEST(LoggerModel, RefusesWhatCannotBeComparedInWords) {
  const auto refused = [](const LoggerRecords& records, const std::string& words) {
    try {
      const LoggerModel model(records);
      FAIL() << words;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr(words));
    }
  };
  LoggerRecords records = recorded({0.0, 0.0, 0.0}, 1);
  LoggerRecords one = records;
  one.value.resize(1);
  one.name.resize(1);
  refused(one, "two records");
  LoggerRecords brief = records;
  brief.value[1].resize(100);
  refused(brief, "logger2 has 100 samples");
  LoggerRecords slow = records;
  slow.rate_hz = 0.0;
  refused(slow, "rate");
  LoggerRecords empty = records;
  for (double& v : empty.value[2]) v = std::numeric_limits<double>::quiet_NaN();
  const LoggerModel model(empty);  // no motion: nothing to align, nothing wild
  EXPECT_TRUE(close(model).steps.empty() || std::isfinite(close(model).steps[0].parameters[1].value));
}

}  // namespace
}  // namespace core::closure
