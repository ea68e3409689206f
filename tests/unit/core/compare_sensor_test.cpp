#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "core/compare/sensor_comparison.h"
#include "core/types/constants.h"

namespace {

using core::Band;
using core::BandLimited;
using core::ComparedRecord;
using core::SensorComparison;

std::vector<double> sampled(double rate_hz, double duration_s, const std::function<double(double)>& of) {
  std::vector<double> out;
  for (int k = 0; k < rate_hz * duration_s; ++k) out.push_back(of(k / rate_hz));
  return out;
}

TEST(BandLimited, PassesTheBandAndStopsTheRest) {
  const auto samples = sampled(50.0, 40.0, [](double t) {
    return 3.0 + 0.5 * t + std::sin(core::kTwoPi * 5.0 * t) + 2.0 * std::sin(core::kTwoPi * 1.0 * t) +
           std::sin(core::kTwoPi * 15.0 * t);
  });
  const BandLimited record(samples, 50.0, {3.0, 10.0}, 0);
  for (double t = 5.0; t < 35.0; t += 0.137) {
    EXPECT_NEAR(record.at(t), std::sin(core::kTwoPi * 5.0 * t), 2e-2);
    EXPECT_NEAR(record.slope_at(t), core::kTwoPi * 5.0 * std::cos(core::kTwoPi * 5.0 * t), 0.7);
  }
}

TEST(BandLimited, IntegratesAnAccelerationToItsDisplacement) {
  const double w = core::kTwoPi * 4.0;
  const auto samples = sampled(200.0, 30.0, [&](double t) { return 9.81 - w * w * std::cos(w * t); });
  const BandLimited record(samples, 200.0, {2.0, 20.0}, 2);
  for (double t = 5.0; t < 25.0; t += 0.0931) EXPECT_NEAR(record.at(t), std::cos(w * t), 1e-2);
}

TEST(BandLimited, SamplesNearAGapDoNotCount) {
  auto samples = sampled(50.0, 10.0, [](double t) { return std::sin(t); });
  samples[250] = core::kNan;
  const BandLimited record(samples, 50.0, {2.0, 8.0}, 0);
  EXPECT_FALSE(record.is_seen(5.0));
  EXPECT_FALSE(record.is_seen(5.0 + 0.09));
  EXPECT_TRUE(record.is_seen(5.0 + 0.12));
  EXPECT_FALSE(record.is_seen(-0.1));
}

TEST(BandLimited, RefusesWhatHasNoBand) {
  const auto samples = sampled(50.0, 10.0, [](double t) { return std::sin(t); });
  EXPECT_THROW(BandLimited(samples, 50.0, {2.0, 25.0}, 0), std::invalid_argument);
  EXPECT_THROW(BandLimited(samples, 50.0, {0.0, 5.0}, 1), std::invalid_argument);
  EXPECT_THROW(BandLimited(std::vector<double>(100, core::kNan), 50.0, {1.0, 5.0}, 0), std::invalid_argument);
}

// A structure with two modes under noise, known at every instant by 400 waves.
class Motion {
 public:
  explicit Motion(unsigned seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> gaussian;
    for (int k = 0; k < 400; ++k) {
      const double f = 0.5 + 0.03 * k;
      const auto gain = [&](double mode) { return 1.0 / std::hypot(1.0 - f * f / (mode * mode), 0.02 * f / mode); };
      waves_.push_back({f + 0.003 * gaussian(random), 0.004 * (gain(4.0) + 0.3 * gain(9.0)) * gaussian(random),
                        6.3 * gaussian(random)});
    }
  }
  // Displacement, or its derivative.
  double operator()(double t, int derivative = 0) const {
    double sum = 0.0;
    for (const Wave& wave : waves_) {
      const double w = core::kTwoPi * wave.f;
      sum += wave.a * std::pow(w, derivative) * std::cos(w * t + wave.phase + derivative * core::kPi / 2.0);
    }
    return sum;
  }

 private:
  struct Wave {
    double f, a, phase;
  };
  std::vector<Wave> waves_;
};

struct Setting {
  unsigned seed = 1;
  double duration_s = 60.0, late_s = 0.3, fast = 50e-6, camera_noise = 0.02, sensor_noise = 0.006, gain = 1.0,
         drift = 0.0, frame_share = 0.0;
  int derivative = 0;
};

struct Pair {
  ComparedRecord camera, sensor;
};

constexpr double kFrame_s = 1.0 / 30.0;

Pair records(const Setting& setting) {
  const Motion motion(setting.seed);
  std::mt19937_64 random(setting.seed + 1000);
  std::normal_distribution<double> gaussian;
  Pair out;
  out.camera = {30.0,
                sampled(30.0, setting.duration_s,
                        [&](double t) {
                          return setting.gain * (motion(t) + setting.frame_share * (motion(t) - motion(t - kFrame_s))) +
                                 setting.camera_noise * gaussian(random) +
                                 setting.drift * std::sin(core::kTwoPi * 0.21 * t);
                        }),
                0};
  out.sensor = {200.0,
                sampled(200.0, setting.duration_s,
                        [&](double s) {
                          return motion(setting.late_s + s / (1.0 + setting.fast), setting.derivative) +
                                 setting.sensor_noise * gaussian(random);
                        }),
                setting.derivative};
  return out;
}

double true_offset_s(const Setting& setting, double camera_s) {
  return (camera_s - setting.late_s) * (1.0 + setting.fast) - camera_s;
}

TEST(SensorComparison, OffsetRateAndAmplitudeAreWithinTheirSigmas) {
  double offset = 0.0, rate = 0.0, amplitude = 0.0;
  constexpr int kSeeds = 20;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    Setting setting;
    setting.seed = seed;
    const Pair pair = records(setting);
    const SensorComparison found = core::compare_with_sensor(pair.camera, pair.sensor, {Band{3.0, 11.0}, {}, {}});
    ASSERT_EQ(found.refusal, "");
    const core::ClockRelation& clock = found.alignment.clock;
    offset += std::pow((clock.offset_s - true_offset_s(setting, clock.middle_s)) / clock.offset_std_s, 2);
    rate += std::pow((clock.rate - setting.fast) / clock.rate_std, 2);
    amplitude += std::pow((found.alignment.ratio - 1.0) / found.alignment.ratio_std, 2);
    // The camera's noise within the band, and a little of the sensor's.
    EXPECT_NEAR(found.rmse, setting.camera_noise * std::sqrt(8.0 / 15.0), 0.1 * setting.camera_noise);
    EXPECT_GT(found.correlation, 0.9);
  }
  // Sum of squares of 20 standard normal numbers: 8 ... 38 at 99 %; blocks widen the tail.
  EXPECT_THAT(offset, testing::AllOf(testing::Gt(8.0), testing::Lt(42.0)));
  EXPECT_THAT(rate, testing::AllOf(testing::Gt(8.0), testing::Lt(42.0)));
  EXPECT_THAT(amplitude, testing::AllOf(testing::Gt(8.0), testing::Lt(42.0)));
}

// A codec that leaves out a twentieth of the motion since the last frame delays by more than the sigma without it.
TEST(SensorComparison, TheDelayOfACodecIsNotTakenForTheClocks) {
  double with = 0.0, without = 0.0;
  constexpr int kSeeds = 12;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    Setting setting;
    setting.seed = seed, setting.frame_share = -0.05;
    const Pair pair = records(setting);
    core::SensorComparisonConfig config{Band{3.0, 11.0}, {}, {}};
    const auto error = [&](const SensorComparison& found) {
      const core::ClockRelation& clock = found.alignment.clock;
      return (clock.offset_s - true_offset_s(setting, clock.middle_s)) / clock.offset_std_s;
    };
    without += std::pow(error(core::compare_with_sensor(pair.camera, pair.sensor, config)), 2);
    config.frames = {kFrame_s, core::FramePrediction::kPast};
    const SensorComparison found = core::compare_with_sensor(pair.camera, pair.sensor, config);
    with += std::pow(error(found), 2);
    EXPECT_NEAR(found.alignment.frame_share, setting.frame_share, 4.0 * found.alignment.frame_share_std);
    EXPECT_LT(found.alignment.frame_share_std, 0.03);
  }
  // Sum of squares of 12 standard normal numbers: 3 ... 28 at 99 %; blocks widen the tail.
  EXPECT_THAT(with, testing::AllOf(testing::Gt(3.0), testing::Lt(32.0)));
  EXPECT_GT(without, 50.0);
}

// One frequency says nothing about the codec beside the clocks: the offset is as uncertain as the codec's delay.
TEST(SensorComparison, ANarrowBandStatesTheCodecsDelayAsUncertain) {
  const Pair pair = records({});
  const auto sigma_s = [&](core::FramePrediction prediction) {
    const core::SensorComparisonConfig config{Band{3.9, 4.1}, {0.5}, {kFrame_s, prediction}};
    return core::compare_with_sensor(pair.camera, pair.sensor, config).alignment.clock.offset_std_s;
  };
  const double w = core::kTwoPi * 4.0, delay_s = std::sin(w * kFrame_s) / w;
  EXPECT_NEAR(sigma_s(core::FramePrediction::kPast), 0.05 * delay_s, 0.015 * delay_s);
  EXPECT_NEAR(sigma_s(core::FramePrediction::kBoth), 0.02 * 2.0 * delay_s, 0.015 * delay_s);
  EXPECT_LT(sigma_s(core::FramePrediction::kNone), 0.02 * delay_s);
}

TEST(SensorComparison, FollowsAClockErrorOfManyPeriods) {
  Setting setting;
  setting.duration_s = 400.0, setting.fast = 900e-6,
  setting.late_s = -4.0;  // 0.36 s over the record: more than three periods
  const Pair pair = records(setting);
  const SensorComparison found = core::compare_with_sensor(pair.camera, pair.sensor, {Band{3.0, 11.0}, {}, {}});
  ASSERT_EQ(found.refusal, "");
  EXPECT_NEAR(1e6 * found.alignment.clock.rate, 900.0, 5.0);
  EXPECT_LT(found.rmse, 1.2 * setting.camera_noise);
}

TEST(SensorComparison, AnAccelerometerIsComparedAsDisplacement) {
  Setting setting;
  setting.derivative = 2, setting.sensor_noise = 1.0, setting.gain = 1.1;
  const Pair pair = records(setting);
  const SensorComparison found = core::compare_with_sensor(pair.camera, pair.sensor, {Band{3.0, 11.0}, {}, {}});
  ASSERT_EQ(found.refusal, "");
  EXPECT_NEAR(found.alignment.ratio, 1.1, 4.0 * found.alignment.ratio_std + 0.003);
  EXPECT_GT(found.rmse, found.rmse_scaled);
}

TEST(SensorComparison, OppositeSignsAreFoundAndSaid) {
  Setting setting;
  setting.gain = -1.0;
  const Pair pair = records(setting);
  const SensorComparison found = core::compare_with_sensor(pair.camera, pair.sensor, {Band{3.0, 11.0}, {}, {}});
  ASSERT_EQ(found.refusal, "");
  EXPECT_NEAR(found.alignment.ratio, -1.0, 0.05);
  EXPECT_GT(found.correlation, 0.9);
}

TEST(SensorComparison, TheBandThatIsChosenLeavesTheDriftOut) {
  Setting setting;
  setting.drift = 30.0;
  const Pair pair = records(setting);
  const SensorComparison found = core::compare_with_sensor(pair.camera, pair.sensor, {});
  ASSERT_EQ(found.refusal, "");
  EXPECT_TRUE(found.band_is_chosen);
  EXPECT_GT(found.band.low_hz, 0.3);
  EXPECT_LT(found.band.low_hz, 4.0);
  EXPECT_GT(found.band.high_hz, 4.0);
  EXPECT_NEAR(found.alignment.clock.offset_s, true_offset_s(setting, found.alignment.clock.middle_s), 0.002);
}

TEST(SensorComparison, RecordsWithoutCommonMotionAreRefused) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> gaussian;
  int n_white = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const auto noise = [&](double) { return gaussian(random); };
    const SensorComparison found = core::compare_with_sensor(
        {30.0, sampled(30.0, 60.0, noise), 0}, {200.0, sampled(200.0, 60.0, noise), 0}, {Band{3.0, 11.0}, {}, {}});
    n_white += found.refusal.empty() ? 1 : 0;
  }
  EXPECT_LE(n_white, 1);
}

TEST(SensorComparison, MissingSamplesDoNotBias) {
  Setting setting;
  Pair pair = records(setting);
  for (std::size_t k = 300; k < 330; ++k) pair.camera.value[k] = core::kNan;
  for (std::size_t k = 50; k < pair.camera.value.size(); k += 97) pair.camera.value[k] = core::kNan;
  const SensorComparison found = core::compare_with_sensor(pair.camera, pair.sensor, {Band{3.0, 11.0}, {}, {}});
  ASSERT_EQ(found.refusal, "");
  EXPECT_NEAR(found.alignment.clock.offset_s, true_offset_s(setting, found.alignment.clock.middle_s),
              4.0 * found.alignment.clock.offset_std_s);
  EXPECT_LT(found.rmse, 1.3 * setting.camera_noise);
}

TEST(SensorComparison, RefusalsAreInWords) {
  Setting setting;
  const Pair pair = records(setting);
  EXPECT_THAT(core::compare_with_sensor({30.0, {1.0}, 0}, pair.sensor, {}).refusal,
              testing::HasSubstr("fewer than 64"));
  EXPECT_THAT(core::compare_with_sensor(pair.camera, pair.sensor, {Band{3.0, 15.0}, {}, {}}).refusal,
              testing::HasSubstr("half the lower rate"));
  EXPECT_THAT(core::compare_with_sensor(pair.camera, pair.sensor, {Band{0.01, 5.0}, {}, {}}).refusal,
              testing::HasSubstr("two periods"));
  EXPECT_THAT(core::compare_with_sensor({30.0, std::vector<double>(100, core::kNan), 0}, pair.sensor, {}).refusal,
              testing::HasSubstr("missing"));
}

}  // namespace
