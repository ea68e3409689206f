#include "core/identification/relative_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/identification/identifier.h"
#include "core/spectrum/welch_cpsd.h"
#include "core/types/constants.h"

namespace core {
namespace {

constexpr double kRate_hz = 25.0;
constexpr int kFine = 8;  // steps of the simulation a sample

// One oscillator under a force, by small steps.
struct Oscillator {
  double hz = 1.0, damping = 0.02, place = 0.0, speed = 0.0;

  double step(double force) {
    const double w = kTwoPi * hz, dt = 1.0 / (kRate_hz * kFine);
    speed += dt * (force - 2.0 * damping * w * speed - w * w * place);
    return place += dt * speed;
  }
};

// Base, four floors and a region at rest at 1.9 times the distance, seen from a camera whose place is held like an
// oscillator. Two modes, the first under the same force as the camera or under one of its own.
struct Gust {
  bool is_shared = true;

  [[nodiscard]] static std::vector<ChannelInfo> channels() {
    std::vector<ChannelInfo> out(6);
    for (std::size_t c = 0; c < out.size(); ++c) out[c].name = "channel" + std::to_string(c);
    out.front().is_base = out.back().is_witness = true;
    return out;
  }

  [[nodiscard]] CpsdSums spectra() const {
    WelchConfig config;
    config.n_channels = 6;
    config.segment = 512;
    config.rate_hz = kRate_hz;
    WelchCpsd welch(config);
    std::mt19937_64 random(4);
    std::normal_distribution<double> gaussian;
    Oscillator first{1.7, 0.02}, second{5.0, 0.01}, camera{0.8, 0.5};
    const std::vector<std::uint8_t> seen(6, 1);
    for (int k = 0; k < 120 * static_cast<int>(kRate_hz); ++k) {
      for (int fine = 0; fine < kFine; ++fine) {
        const double gust = 1e3 * gaussian(random), other = 1e3 * gaussian(random);
        first.step(is_shared ? gust : other), camera.step(gust), second.step(1e3 * gaussian(random));
      }
      std::vector<double> value{camera.place};
      for (const double h : {0.25, 0.5, 0.75, 1.0})
        value.push_back(camera.place + h * first.place + (1.0 - 2.6 * h * h) * second.place);
      value.push_back(camera.place / 1.9);
      for (double& v : value) v += 0.02 * gaussian(random);
      welch.push(value, seen);
    }
    welch.flush();
    return welch.sums();
  }
};

const Mode* structural_at(const ModalEstimate& estimate, double hz) {
  const auto at = std::find_if(estimate.modes.begin(), estimate.modes.end(),
                               [&](const Mode& mode) { return std::abs(mode.frequency_hz - hz) < 0.02 * hz; });
  return at == estimate.modes.end() ? nullptr : &*at;
}

TEST(RelativeMotion, TheCameraCancelsAtTheInstantOfEachRow) {
  std::vector<ChannelInfo> channels(3);
  channels[0].is_base = true, channels[0].row_delay_s = 0.004;
  channels[1].row_delay_s = 0.031;
  channels[2].row_delay_s = 0.017, channels[2].direction_u = -1.0;
  WelchConfig config;
  config.n_channels = 3;
  config.segment = 512;
  config.rate_hz = kRate_hz;
  WelchCpsd welch(config);
  const std::vector<std::uint8_t> seen(3, 1);
  for (int k = 0; k < 3000; ++k) {
    std::vector<double> value;
    for (const ChannelInfo& channel : channels) {
      const double t = k / kRate_hz + channel.row_delay_s;
      value.push_back(channel.direction_u * (std::sin(kTwoPi * 1.3 * t) + 0.5 * std::sin(kTwoPi * 7.1 * t + 1.0)));
    }
    welch.push(value, seen);
  }
  welch.flush();
  const CpsdSums sums = welch.sums();
  const CpsdSums relative = relative_to_base(sums, channels, 0);
  const auto power = [](const CpsdSums& of, int c) {
    double sum = 0.0;
    for (int k = 0; k < of.n_bins(); ++k) {
      sum += of.data_sum[static_cast<std::size_t>(k) * static_cast<std::size_t>(of.n_pairs()) +
                         static_cast<std::size_t>(CpsdSums::pair_index(c, c, 3))]
                 .real();
    }
    return sum;
  };
  EXPECT_EQ(power(relative, 0), power(sums, 0));
  for (const int c : {1, 2}) EXPECT_LT(power(relative, c), 1e-4 * power(sums, c)) << c;
  for (const CpsdBlock& block : relative.blocks) {
    if (block.n_segments == 0) continue;
    for (std::size_t k = 0; k < block.data_sum.size(); k += 6)
      EXPECT_LT(std::abs(block.data_sum[k + 3]), 1e-2 * power(sums, 1));
  }
}

TEST(SharedMotion, IsWhatTheForceOfTheGustDoesToTheStructure) {
  for (const bool is_shared : {true, false}) {
    const CpsdSums sums = Gust{is_shared}.spectra();
    const std::vector<ChannelInfo> channels = Gust::channels();
    const CpsdSums relative = relative_to_base(sums, channels, 0);
    const SharedMotion shared(sums, relative, channels, 0);
    EXPECT_EQ(shared.at(1.7), is_shared);
    EXPECT_EQ(shared.anywhere(), is_shared);
    EXPECT_FALSE(shared.at(5.0));
  }
}

// Frames that all channels lack make the noise of a region at rest coherent with the channels' at any frequency.
TEST(SharedMotion, IsNoneWhereTheRegionAtRestShowsItsNoise) {
  CpsdSums sums = Gust{false}.spectra();
  const std::vector<ChannelInfo> channels = Gust::channels();
  const auto at = [&](int bin, int i, int j) {
    return static_cast<std::size_t>(bin) * static_cast<std::size_t>(sums.n_pairs()) +
           static_cast<std::size_t>(CpsdSums::pair_index(i, j, sums.n_channels));
  };
  const auto follow_floor = [&](double hz, double factor) {  // the region at rest moves as the upper floor does
    const int bin = static_cast<int>(std::lround(hz * sums.n_fft / sums.rate_hz));
    for (int k = bin - 1; k <= bin + 1; ++k) {
      sums.data_sum[at(k, 5, 5)] *= factor;
      const double both = std::sqrt(sums.data_sum[at(k, 4, 4)].real() * sums.data_sum[at(k, 5, 5)].real());
      sums.data_sum[at(k, 4, 5)] = 0.95 * both;
    }
  };
  follow_floor(11.0, 1.0);
  const CpsdSums in_noise = sums;
  EXPECT_FALSE(SharedMotion(in_noise, in_noise, channels, 0).at(11.0));
  follow_floor(11.0, 10.0);
  EXPECT_TRUE(SharedMotion(sums, sums, channels, 0).at(11.0));
}

TEST(SharedMotion, AModeUnderAGustThatMovesTheCameraIsFound) {
  const ModalEstimate estimate = Identifier({}, Gust::channels()).identify(Gust{true}.spectra());
  const Mode *first = structural_at(estimate, 1.7), *second = structural_at(estimate, 5.0);
  ASSERT_NE(first, nullptr);
  ASSERT_NE(second, nullptr);
  EXPECT_NEAR(first->damping_ratio, 0.02, 0.01);
  EXPECT_NE(first->reason.find("relative to the base"), std::string::npos) << first->reason;
  ASSERT_EQ(first->shape.size(), 5U);
  EXPECT_EQ(first->shape[0], 0.0);
  for (std::size_t c = 1; c < 5; ++c) EXPECT_NEAR(first->shape[c].real(), 0.25 * static_cast<double>(c), 0.03);
  EXPECT_TRUE(first->frequency_std_hz.has_value());
  EXPECT_NE(second->reason.find("relative to the base"), std::string::npos) << "as every mode beside a shared one";
  const int n_listed = static_cast<int>(estimate.modes.size() + estimate.rejected.size());
  for (const StabilisationPole& pole : estimate.poles) {
    ASSERT_LT(pole.i_line, n_listed);
    if (pole.i_line < 0) continue;
    const auto line = static_cast<std::size_t>(pole.i_line);
    const Mode& mode =
        line < estimate.modes.size() ? estimate.modes[line] : estimate.rejected[line - estimate.modes.size()];
    EXPECT_NEAR(pole.apparent_hz, mode.apparent_hz, 0.1 * mode.apparent_hz) << "a pole names a line of its own";
  }
}

}  // namespace
}  // namespace core
