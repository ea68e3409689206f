#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "core/closure/closure_loop.h"
#include "core/closure/noise_stream.h"
#include "core/closure/response/channel_model.h"
#include "core/closure/response/response_level.h"

namespace core::closure {
namespace {

using ::testing::HasSubstr;

constexpr double kRate_hz = 25.0;
constexpr int kFine = 40, kSamples = 3000;

struct Made {
  double drift = 0.0;  // of the frequencies over the record
  double jitter_s = 0.0;
  int drop_every = 0, repeat_every = 0;
};

// Two floors with modes at 1.9 and 5.2 Hz, 1 % damping, under independent white forces.
ChannelRecord made(const Made& what, std::uint64_t seed) {
  constexpr double kHz[2] = {1.9, 5.2};
  constexpr double kShape[2][2] = {{0.6, 1.0}, {1.0, -0.6}};
  NoiseStream noise(seed);
  double x[2] = {}, v[2] = {};
  std::vector<Eigen::Vector2d> fine;
  for (int k = 0; k < (kSamples + 60) * kFine; ++k) {
    const double share = static_cast<double>(k) / (kSamples * kFine) - 0.5;
    Eigen::Vector2d seen = Eigen::Vector2d::Zero();
    for (int m = 0; m < 2; ++m) {
      const double w = 2.0 * std::numbers::pi * kHz[m] * (1.0 + what.drift * share), h = 1.0 / (kRate_hz * kFine);
      v[m] += h * (-2.0 * 0.01 * w * v[m] - w * w * x[m]) + std::sqrt(h) * 5.0 * noise.gaussian();
      x[m] += h * v[m];
      for (int c = 0; c < 2; ++c) seen(c) += kShape[m][c] * x[m];
    }
    fine.push_back(seen);
  }
  std::vector<Eigen::Vector2d> rows;
  for (int k = 1; k <= kSamples; ++k) {
    if (what.drop_every > 0 && k % what.drop_every == 0) continue;
    const double at = k * kFine + what.jitter_s * noise.gaussian() * kRate_hz * kFine;
    Eigen::Vector2d row = fine[static_cast<std::size_t>(std::lround(std::max(at, 0.0)))];
    for (double& value : row) value += 0.002 * noise.gaussian();
    rows.push_back(what.repeat_every > 0 && k % what.repeat_every == 0 ? rows.back() : row);
  }
  ChannelRecord out;
  out.rate_hz = kRate_hz;
  out.value.resize(static_cast<Eigen::Index>(rows.size()), 2);
  for (std::size_t k = 0; k < rows.size(); ++k) out.value.row(static_cast<Eigen::Index>(k)) = rows[k].transpose();
  return out;
}

ClosureResult close(const ChannelRecord& record) {
  const ChannelModel model(record);
  ResponseLevel level(model);
  ClosureOptions options;
  options.n_surrogates = 16;
  return close_loop(level, options);
}

void expect_named(const Made& what, const std::string& effect, double value, double tolerance) {
  const ClosureResult result = close(made(what, 1));
  ASSERT_EQ(result.steps.size(), 1U) << effect;
  EXPECT_EQ(result.steps[0].effect, effect);
  EXPECT_NEAR(result.steps[0].parameters.at(0).value, value, tolerance);
  EXPECT_LT(result.steps[0].heldout_after, result.steps[0].heldout_before);
}

TEST(ChannelModel, DriftOfTheFrequenciesIsNamed) { expect_named({.drift = 0.06}, "frequency_drift", 6.0, 2.5); }
TEST(ChannelModel, JitterOfTheTimeStampsIsNamed) { expect_named({.jitter_s = 4e-3}, "time_stamp_jitter", 4.0, 1.2); }
TEST(ChannelModel, DroppedFramesAreCounted) { expect_named({.drop_every = 97}, "dropped_frames", 30.0, 3.0); }
TEST(ChannelModel, RepeatedFramesAreCounted) { expect_named({.repeat_every = 97}, "duplicated_frames", 30.0, 0.5); }

TEST(ChannelModel, LinearStructureUnderWhiteForcesLeavesNothing) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const ClosureResult result = close(made({}, seed));
    EXPECT_TRUE(result.steps.empty()) << "seed " << seed << ": " << result.steps.front().effect;
  }
}

TEST(ChannelModel, GapsAndNaNLeaveNoNaNInTheResult) {
  ChannelRecord record = made({}, 1);
  for (Eigen::Index k = 100; k < record.n_samples(); k += 211)
    record.value(k, 0) = std::numeric_limits<double>::quiet_NaN();
  record.value(500, 1) = std::numeric_limits<double>::infinity();
  const ClosureResult result = close(record);
  EXPECT_TRUE(std::isfinite(result.residual_rms));
  EXPECT_TRUE(result.steps.empty());
}

TEST(ChannelModel, RefusesWhatCannotBePredictedInWords) {
  const auto refused = [](const ChannelRecord& record, const std::string& words) {
    try {
      const ChannelModel model(record);
      FAIL() << words;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr(words));
    }
  };
  ChannelRecord record = made({}, 1);
  ChannelRecord brief = record;
  brief.value = record.value.topRows(40).eval();
  refused(brief, "40 samples are too few");
  ChannelRecord still = record;
  still.value.col(1).setConstant(3.0);
  refused(still, "channel 2 does not move");
  ChannelRecord slow = record;
  slow.rate_hz = 0.0;
  refused(slow, "rate");
}

}  // namespace
}  // namespace core::closure
