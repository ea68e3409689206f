// The response level for records whose clock, camera or structure changes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/closure/closure_loop.h"
#include "core/closure/noise_stream.h"
#include "core/closure/response/channel_model.h"
#include "core/closure/response/channel_retime.h"
#include "core/closure/response/effects/step_likelihood.h"
#include "core/closure/response/response_level.h"

namespace core::closure {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kRate_hz = 25.0, kDelay_s = 0.02;
constexpr int kFine = 40, kSamples = 3000;

struct Made {
  double drift = 0.0;   // of the frequencies over the record
  double hover = 0.0;   // of a camera that drifts at 0.1 Hz, times the structure's motion; seen by all channels
  int shock_every = 0;  // samples after which something hits the structure
  int drop_every = 0, insert_every = 0, replace_every = 0;
};

// Two floors with modes at 1.9 and 5.2 Hz, 1 % damping, under independent white forces; the second is seen 20 ms after
// the first, and the static base together with the first.
ChannelRecord made(const Made& what, std::uint64_t seed) {
  constexpr double kHz[2] = {1.9, 5.2};
  constexpr double kShape[2][2] = {{0.6, 1.0}, {1.0, -0.6}};
  NoiseStream noise(seed);
  double x[2] = {}, v[2] = {};
  std::vector<Eigen::Vector3d> fine;  // floors, base
  for (int k = 0; k < (kSamples + 120) * kFine; ++k) {
    const double share = static_cast<double>(k) / (kSamples * kFine) - 0.5;
    const double t_s = k / (kRate_hz * kFine);
    Eigen::Vector3d seen = Eigen::Vector3d::Constant(what.hover * std::sin(0.2 * std::numbers::pi * t_s));
    for (int m = 0; m < 2; ++m) {
      const double w = 2.0 * std::numbers::pi * kHz[m] * (1.0 + what.drift * share), h = 1.0 / (kRate_hz * kFine);
      v[m] += h * (-2.0 * 0.01 * w * v[m] - w * w * x[m]) + std::sqrt(h) * 5.0 * noise.gaussian();
      if (what.shock_every > 0 && k % (what.shock_every * kFine) == 7) v[m] += 30.0;
      x[m] += h * v[m];
      for (int c = 0; c < 2; ++c) seen(c) += kShape[m][c] * x[m];
    }
    fine.push_back(seen);
  }
  const int later = static_cast<int>(std::lround(kDelay_s * kRate_hz * kFine));
  std::vector<Eigen::Vector3d> rows;
  for (int k = 1; k <= kSamples; ++k) {
    if (what.drop_every > 0 && k % what.drop_every == 0) continue;
    const auto at = static_cast<std::size_t>(k * kFine);
    Eigen::Vector3d row(fine[at](0), fine[at + static_cast<std::size_t>(later)](1), fine[at](2));
    for (double& value : row) value += 0.002 * noise.gaussian();
    if (what.replace_every > 0 && k % what.replace_every == 0) row = rows.back();
    rows.push_back(row);
    if (what.insert_every > 0 && k % what.insert_every == 0) rows.push_back(row);
  }
  ChannelRecord out;
  out.rate_hz = kRate_hz;
  out.value.resize(static_cast<Eigen::Index>(rows.size()), 2);
  out.input.resize(static_cast<Eigen::Index>(rows.size()), 1);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    out.value.row(static_cast<Eigen::Index>(k)) = rows[k].head<2>().transpose();
    out.input(static_cast<Eigen::Index>(k), 0) = rows[k](2);
  }
  out.delay_s = {0.0, kDelay_s}, out.input_delay_s = {0.0};
  out.input_alike = true;
  return out;
}

ClosureResult close(const ChannelModel& model) {
  ResponseLevel level(model);
  ClosureOptions options;
  options.n_surrogates = 16;
  return close_loop(level, options);
}

std::vector<std::string> names_of(const ClosureResult& result) {
  std::vector<std::string> out;
  for (const ClosureStep& step : result.steps) out.push_back(step.effect);
  return out;
}

TEST(ChannelClockEffects, ADriftIsNamedBehindADriftingCameraWithTheBaseAsInput) {
  const ChannelModel model(made({.drift = 0.05, .hover = 20.0}, 1));
  const ClosureResult result = close(model);
  ASSERT_THAT(names_of(result), Contains("frequency_drift"));
  const ParameterValue& change = result.steps.front().parameters.front();
  EXPECT_NEAR(change.value, 5.0, 3.0 * change.sigma.value());
  EXPECT_LT(change.sigma.value(), 1.5);
}

TEST(ChannelClockEffects, MotionRelativeToTheBaseIsTakenAtEachChannelsOwnInstant) {
  const ChannelRecord still = relative_to_input(made({.hover = 0.0}, 2));
  const ChannelRecord moving = relative_to_input(made({.hover = 20.0}, 2));
  const Eigen::Index n = still.n_samples() - 4;
  EXPECT_LT((moving.value - still.value).middleRows(2, n).cwiseAbs().maxCoeff(), 0.01)
      << "20 ms at 12.6 a second would leave 0.25";
}

TEST(ChannelClockEffects, ShocksAreNotLostFrames) {
  const ChannelModel model(made({.shock_every = 97}, 3));
  EXPECT_THAT(names_of(close(model)), Not(Contains("dropped_frames")));
}

TEST(ChannelClockEffects, LostFramesAreCountedWithASigmaThatHolds) {
  const ChannelModel model(made({.drop_every = 97}, 4));
  const ClosureResult result = close(model);
  ASSERT_THAT(names_of(result), Contains("dropped_frames"));
  const ParameterValue& drops = result.steps.front().parameters.front();
  ASSERT_TRUE(drops.sigma.has_value());
  EXPECT_LE(std::abs(drops.value - 30.0), std::max(3.0 * *drops.sigma, 0.5)) << drops.value << " +- " << *drops.sigma;
}

TEST(ChannelClockEffects, DropsUnderAnAverageRateLeaveTheDuration) {
  ChannelRecord record = made({.drop_every = 97}, 5);
  record.rate_is_average = true;
  record.rate_hz = kRate_hz * static_cast<double>(record.n_samples()) / kSamples;
  const ChannelModel average(record);
  const ChannelRecord after = average.corrected({"dropped_frames"});
  EXPECT_NEAR(after.rate_hz, kRate_hz, 0.003 * kRate_hz);
  record.rate_is_average = false;
  EXPECT_DOUBLE_EQ(ChannelModel(record).corrected({"dropped_frames"}).rate_hz, record.rate_hz);
}

TEST(ChannelClockEffects, InsertedRepeatsAreTakenOutAndReplacedFramesAreGaps) {
  const ChannelRecord inserted = made({.insert_every = 97}, 6);
  const ChannelRecord mended = ChannelModel(inserted).corrected({"duplicated_frames"});
  EXPECT_EQ(mended.n_samples(), kSamples);
  EXPECT_TRUE(mended.value.allFinite());
  const ChannelRecord replaced = made({.replace_every = 97}, 6);
  const ChannelRecord blanked = ChannelModel(replaced).corrected({"duplicated_frames"});
  EXPECT_EQ(blanked.n_samples(), kSamples);
  EXPECT_EQ((blanked.value.col(0).array().isNaN()).count(), 30);
}

TEST(ChannelClockEffects, ARepeatOfATrackerThatStartsElsewhereIsStillARepeat) {
  ChannelRecord record = made({.insert_every = 97}, 7);
  NoiseStream noise(8);
  for (Eigen::Index k = 0; k < record.n_samples(); ++k) {
    for (Eigen::Index c = 0; c < record.value.cols(); ++c) record.value(k, c) += 2e-5 * noise.gaussian();
  }
  EXPECT_EQ(ChannelModel(record).corrected({"duplicated_frames"}).n_samples(), kSamples);
}

TEST(ChannelClockEffects, KnownTimesLeaveNoClockEffectToFind) {
  ChannelRecord record = made({.drop_every = 97}, 9);
  record.times_known = true;
  const ChannelModel model(record);
  for (const char* effect : {"dropped_frames", "duplicated_frames", "time_stamp_jitter"})
    EXPECT_THAT(model.effects(), Not(Contains(effect)));
  std::vector<std::string> unobservable;
  for (const NotObservable& effect : model.not_observable()) unobservable.push_back(effect.effect);
  EXPECT_THAT(unobservable, Contains("dropped_frames"));
}

TEST(ChannelRetime, AChirpBecomesASine) {
  constexpr Eigen::Index kN = 2000;
  Eigen::VectorXd factor(kN);
  for (Eigen::Index k = 0; k < kN; ++k) factor(k) = 1.0 + 0.1 * (static_cast<double>(k) / kN - 0.5);
  const Eigen::VectorXd time_s = time_of_factor(factor, kRate_hz);
  ChannelRecord record;
  record.rate_hz = kRate_hz;
  record.value.resize(kN, 1), record.input.resize(kN, 0);
  // The phase is that of 2 Hz along the time that the factor makes.
  for (Eigen::Index k = 0; k < kN; ++k) record.value(k, 0) = std::sin(4.0 * std::numbers::pi * time_s(k));
  const ChannelRecord out = retimed(record, time_s);
  for (Eigen::Index k = 2; k + 2 < out.n_samples(); ++k)
    ASSERT_NEAR(out.value(k, 0), std::sin(4.0 * std::numbers::pi * static_cast<double>(k) / kRate_hz), 0.01);
}

TEST(ChannelRetime, AWarpKeepsAmplitudesUpToFourTenthsOfTheRate) {
  constexpr Eigen::Index kN = 1000;
  const Eigen::VectorXd factor = Eigen::VectorXd::LinSpaced(kN, 0.97, 1.03);
  const Eigen::VectorXd time_s = time_of_factor(factor, kRate_hz);
  ChannelRecord record;
  record.rate_hz = kRate_hz;
  record.value.resize(kN, 1), record.input.resize(kN, 0);
  const auto wave = [](double t_s) { return std::sin(2.0 * std::numbers::pi * 10.0 * t_s); };
  for (Eigen::Index k = 0; k < kN; ++k) record.value(k, 0) = wave(time_s(k));
  const ChannelRecord out = warped(record, time_s);
  for (Eigen::Index k = 20; k + 20 < out.n_samples(); ++k)
    ASSERT_NEAR(out.value(k, 0), wave(static_cast<double>(k) / kRate_hz), 0.02) << k;
}

TEST(ChannelRetime, NoSampleIsMadeAcrossAGap) {
  ChannelRecord record;
  record.rate_hz = 10.0;
  record.value = Eigen::MatrixXd::Ones(100, 1), record.input.resize(100, 0);
  record.value(50, 0) = std::numeric_limits<double>::quiet_NaN();
  const ChannelRecord out = retimed(record, Eigen::VectorXd::LinSpaced(100, 0.0, 9.95));
  EXPECT_EQ(out.value.col(0).array().isNaN().count(), 2);
}

TEST(EventCount, IsTheSumOfProbabilitiesWithItsVariance) {
  std::vector<double> ratios(3000, -20.0);
  for (std::size_t i = 0; i < 30; ++i) ratios[100 * i] = 30.0;
  const EventCount clear = count_events(ratios);
  EXPECT_NEAR(clear.count, 30.0, 1e-3);
  EXPECT_LT(clear.sigma, 0.1);
  EXPECT_EQ(clear.likely.size(), 30U);
  EXPECT_GT(clear.evidence, 100.0);
  for (std::size_t i = 0; i < 10; ++i) ratios[100 * i] = std::log(99.0);  // equal odds, at a share of 1 %
  const EventCount doubtful = count_events(ratios);
  EXPECT_GT(doubtful.sigma, 1.0);
  EXPECT_LT(doubtful.sigma, 4.0);
  EXPECT_LE(count_events(std::vector<double>(3000, -0.5)).evidence, 0.0);
}

// A model that contains one effect, with size and sigma given by the test.
class OneEffect final : public ResponseModel {
 public:
  explicit OneEffect(ParameterValue size) : size_(std::move(size)) {}
  std::string unit() const override { return "px"; }
  std::vector<std::string> effects() const override { return {"softening"}; }
  std::vector<NotObservable> not_observable() const override { return {}; }
  double material_share(const std::string&) const override { return 0.0; }
  ResponseFit fit(const std::vector<std::string>& effects) const override {
    ResponseFit out;
    out.heldout_rms = effects.empty() ? 2.0 : 1.0;
    out.fold_squares.assign(10, effects.empty() ? 40.0 : 10.0);
    for (std::size_t i = 0; i < effects.size(); ++i) out.parameters.push_back({size_}), out.implausible.emplace_back();
    return out;
  }
  std::unique_ptr<ResponseModel> surrogate(const std::vector<std::string>&, std::uint64_t) const override {
    return std::make_unique<Without>();
  }

 private:
  class Without final : public ResponseModel {
   public:
    std::string unit() const override { return "px"; }
    std::vector<std::string> effects() const override { return {"softening"}; }
    std::vector<NotObservable> not_observable() const override { return {}; }
    double material_share(const std::string&) const override { return 0.0; }
    ResponseFit fit(const std::vector<std::string>&) const override {
      ResponseFit out;
      out.heldout_rms = 1.0;
      return out;
    }
    std::unique_ptr<ResponseModel> surrogate(const std::vector<std::string>&, std::uint64_t) const override {
      return std::make_unique<Without>();
    }
  };
  ParameterValue size_;
};

TEST(ResponseLevel, AnEffectWithinThreeSigmaOfZeroIsNotAdoptedAndSaidSo) {
  const OneEffect faint({"stiffness_change", "%", -2.2, 2.8}), clear({"stiffness_change", "%", -9.0, 2.8});
  ResponseLevel level(faint), other(clear);
  ClosureOptions options;
  options.n_surrogates = 16;
  const ClosureResult result = close_loop(level, options);
  EXPECT_TRUE(result.steps.empty());
  ASSERT_EQ(result.refused.size(), 1U);
  EXPECT_THAT(result.refused.front().refusal, HasSubstr("cannot be distinguished from zero: -2.2 +- 2.8 %"));
  EXPECT_EQ(close_loop(other, options).steps.size(), 1U);
}

}  // namespace
}  // namespace core::closure
