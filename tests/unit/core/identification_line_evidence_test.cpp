#include "core/identification/line_evidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/spectrum/welch_cpsd.h"

namespace core {
namespace {

using Complex = std::complex<double>;
constexpr double kRate_hz = 25.0, kTwoPi = 2.0 * std::numbers::pi;
const std::vector<double> kRowShare{0.9, 0.74, 0.58, 0.42, 0.26, 0.1};
const std::vector<double> kShape{1.0, 0.6, -0.2, -0.7, -0.9, -0.4};

FoldingConfig rows(double readout_frames) {
  FoldingConfig folding{kRate_hz, 20.0, {}};
  for (const double share : kRowShare) folding.delay_s.push_back(readout_frames / kRate_hz * share);
  return folding;
}

// Ten minutes of one oscillator in white noise, or of a steady line, in a given shape.
CpsdSums record(double frequency_hz, double damping_ratio, bool steady) {
  WelchConfig config;
  config.n_channels = 6;
  config.segment = 1024;
  config.rate_hz = kRate_hz;
  WelchCpsd welch(config);
  std::mt19937 random(1);
  std::normal_distribution<double> gaussian;
  const Complex lambda = std::exp(Complex(-damping_ratio, 1.0) * kTwoPi * frequency_hz / kRate_hz);
  Complex state = 30.0;
  std::vector<double> value(6);
  const std::vector<std::uint8_t> seen(6, 1);
  for (int k = 0; k < 15000; ++k) {
    state = lambda * state + (steady ? 0.0 : gaussian(random));
    if (steady) state *= 30.0 / std::abs(state);
    for (std::size_t c = 0; c < 6; ++c) value[c] = kShape[c] * state.real() + gaussian(random);
    welch.push(value, seen);
  }
  return welch.sums();
}

UnfoldedPole pole_at(double frequency_hz, double damping_ratio, std::vector<Complex> shape) {
  UnfoldedPole pole;
  pole.s = kTwoPi * frequency_hz * Complex(-damping_ratio, std::sqrt(1.0 - damping_ratio * damping_ratio));
  pole.apparent_hz = frequency_hz;
  pole.shape = std::move(shape);
  return pole;
}

const std::vector<Complex> kPlain(kShape.begin(), kShape.end());

TEST(SpectralLineEvidence, ASteadyLineDoesNotDecay) {
  const FoldingConfig folding = rows(0.0);
  const CpsdSums sums = record(4.0, 0.0, true);
  const SpectralLineEvidence line = SpectralLineTest(sums, folding).examine(pole_at(4.0, 0.0005, kPlain));
  ASSERT_TRUE(line.late_damping_ratio.has_value());
  EXPECT_LT(std::abs(*line.late_damping_ratio), 2e-4);
  EXPECT_GT(line.late_share, 0.9);
}

TEST(SpectralLineEvidence, AModeDecaysAsMuchAsItIsDamped) {
  const FoldingConfig folding = rows(0.0);
  const CpsdSums sums = record(5.0, 0.004, false);
  const SpectralLineEvidence mode = SpectralLineTest(sums, folding).examine(pole_at(5.0, 0.004, kPlain));
  ASSERT_TRUE(mode.late_damping_ratio.has_value());
  EXPECT_LT(mode.late_share, 0.4);
}

// With 0.1 % damping, a decay by a fifth takes 32 cycles: the lags of a segment contain fewer of a slow line.
TEST(SpectralLineEvidence, LinesTooSlowForTheSegmentAreNotExamined) {
  const FoldingConfig folding = rows(0.0);
  const CpsdSums sums = record(1.0, 0.0, true);
  EXPECT_FALSE(SpectralLineTest(sums, folding).examine(pole_at(1.0, 0.0005, kPlain)).late_damping_ratio.has_value());
}

TEST(SpectralLineEvidence, WellDampedPolesAreNotExamined) {
  const FoldingConfig folding = rows(0.0);
  const CpsdSums sums = record(2.0, 0.02, false);
  EXPECT_FALSE(SpectralLineTest(sums, folding).examine(pole_at(2.0, 0.02, kPlain)).late_damping_ratio.has_value());
}

// Yaw and roll of the camera at a rate far above the modes, each with its own phase.
std::vector<Complex> shaken(double true_hz, const FoldingConfig& folding) {
  std::vector<Complex> shape;
  for (std::size_t c = 0; c < 6; ++c) {
    shape.push_back((Complex(1.0, 0.0) + Complex(0.2, 0.9) * (kRowShare[c] - 0.5)) *
                    std::polar(1.0, kTwoPi * true_hz * folding.delay_s[c]));
  }
  return shape;
}

TEST(SpectralLineEvidence, AShakingCameraIsSeenThroughTheDelaysOfItsRows) {
  const FoldingConfig folding = rows(0.66);
  const CpsdSums sums = record(4.0, 0.01, false);
  for (const double true_hz : {79.0, 96.0, 104.0, 146.0}) {
    // The apparent pole has the conjugate shape if the signed frequency is negative.
    const double signed_hz = std::remainder(true_hz, kRate_hz) < 0.0 ? -true_hz : true_hz;
    UnfoldedPole pole = pole_at(std::abs(std::remainder(true_hz, kRate_hz)), 0.0, shaken(signed_hz, folding));
    const FoldingConfig none = {kRate_hz, 20.0, std::vector<double>(6, 0.0)};
    for (std::size_t c = 0; c < 6; ++c) pole.shape[c] *= std::exp(-pole.s * folding.delay_s[c]);  // as if n were 0
    const SpectralLineEvidence line = SpectralLineTest(sums, folding).examine(pole);
    EXPECT_GT(line.camera_mac, 0.9999) << true_hz;
    EXPECT_NEAR(line.camera_hz, true_hz, 1e-9);
    EXPECT_EQ(SpectralLineTest(sums, none).examine(pole).camera_mac, 0.0) << "without delays nothing tells";
  }
}

TEST(SpectralLineEvidence, AModeOfTheStructureIsNoShakingCamera) {
  const CpsdSums sums = record(4.0, 0.01, false);
  const std::vector<Complex> sway{1.0, 0.9, 0.75, 0.55, 0.35, 0.1};  // nearly a slope
  for (const double readout : {0.05, 0.3, 0.66, 0.9}) {
    const FoldingConfig folding = rows(readout);
    for (const auto& shape : {kPlain, sway}) {
      EXPECT_LT(SpectralLineTest(sums, folding).examine(pole_at(1.7, 0.01, shape)).camera_mac, 0.95) << readout;
    }
  }
}

}  // namespace
}  // namespace core
