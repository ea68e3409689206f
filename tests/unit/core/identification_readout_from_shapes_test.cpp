#include "core/identification/readout_from_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace core {
namespace {

using Complex = std::complex<double>;
constexpr double kRate_hz = 25.0;
const std::vector<double> kRowShare{0.95, 0.77, 0.59, 0.41, 0.23, 0.05};

// A real shape at a true frequency, as frames read out over `readout_frames` show it.
ObservedPole seen(double true_hz, const std::vector<double>& shape, double readout_frames) {
  ObservedPole pole;
  pole.apparent_hz = std::abs(true_hz - kRate_hz * std::round(true_hz / kRate_hz));
  const double signed_hz = std::remainder(true_hz, kRate_hz) < 0.0 ? -true_hz : true_hz;
  for (std::size_t c = 0; c < shape.size(); ++c) {
    pole.shape.push_back(
        std::polar(1.0, 2.0 * std::numbers::pi * signed_hz * readout_frames / kRate_hz * kRowShare[c]) * shape[c] *
        Complex(0.3, 0.8));
  }
  return pole;
}

std::vector<ObservedPole> four_modes(double readout_frames) {
  return {seen(5.04, {0.4, 0.9, 1.0, 0.5, -0.3, -0.9}, readout_frames),
          seen(8.14, {0.8, 0.7, -0.5, -1.0, -0.1, 0.9}, readout_frames),
          seen(12.93, {0.7, -1.0, 0.6, 0.3, -0.9, 0.5}, readout_frames),
          seen(14.34, {0.5, -0.8, 1.0, -0.9, 0.7, -0.3}, readout_frames)};
}

const ReadoutSearch kSearch{kRate_hz, 20.0, 1.0};

TEST(ReadoutFromShapes, FindsTheReadoutThatMakesShapesReal) {
  for (const double readout : {0.9, 0.66, 0.3, -0.66}) {
    const auto found = readout_from_shapes(four_modes(readout), kRowShare, kSearch);
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(found->readout_frames, readout, 1e-3);
    EXPECT_GT(found->mean_mpc, 0.9999);
    EXPECT_LT(found->std_frames, 1e-3);
    EXPECT_EQ(found->n_poles, 4);
  }
}

TEST(ReadoutFromShapes, OfGlobalShuttersIsZero) {
  const auto found = readout_from_shapes(four_modes(0.0), kRowShare, kSearch);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->readout_frames, 0.0, 1e-3);
}

TEST(ReadoutFromShapes, PolesThatDisagreeWidenTheSpread) {
  std::vector<ObservedPole> poles = four_modes(0.66);
  poles[3] = four_modes(0.72)[3];
  const auto found = readout_from_shapes(poles, kRowShare, kSearch);
  ASSERT_TRUE(found.has_value());
  EXPECT_GT(found->readout_frames, 0.66);
  EXPECT_LT(found->readout_frames, 0.72);
  EXPECT_GT(found->std_frames, 0.005);
}

TEST(ReadoutFromShapes, IsEmptyWhereNothingTellsIt) {
  const std::vector<ObservedPole> poles = four_modes(0.66);
  EXPECT_FALSE(readout_from_shapes({}, kRowShare, kSearch).has_value());
  EXPECT_FALSE(readout_from_shapes({poles.data(), 1}, kRowShare, kSearch).has_value()) << "one pole has no spread";
  EXPECT_FALSE(readout_from_shapes(poles, std::vector<double>(6, 0.5), kSearch).has_value()) << "all in one row";
  EXPECT_FALSE(readout_from_shapes(poles, std::vector<double>{0.1, 0.9}, kSearch).has_value()) << "other channels";
  std::vector<ObservedPole> lost = poles;
  lost[1].apparent_hz = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(readout_from_shapes(lost, kRowShare, kSearch).has_value());
}

TEST(ObservedPole, HasTheDelaysPutBack) {
  constexpr double kReadout = 0.66;
  std::vector<ChannelInfo> channels(6);
  for (std::size_t c = 0; c < 6; ++c) channels[c].row_delay_s = kReadout / kRate_hz * kRowShare[c];
  for (const auto& [true_hz, n] : {std::pair{8.14, 0}, std::pair{14.34, -1}}) {
    const std::vector<double> shape{0.5, -0.8, 1.0, -0.9, 0.7, -0.3};
    Mode mode;
    mode.frequency_hz = true_hz;
    mode.apparent_hz = n == 0 ? true_hz : kRate_hz - true_hz;
    mode.fold_n = n;
    mode.shape.assign(shape.begin(), shape.end());
    const ObservedPole expected = seen(true_hz, shape, kReadout), pole = observed_pole(mode, channels, kRate_hz);
    const Complex factor = pole.shape[0] / expected.shape[0];
    for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(std::abs(pole.shape[c] - factor * expected.shape[c]), 0.0, 1e-12);
  }
}

}  // namespace
}  // namespace core
