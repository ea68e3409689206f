#include "core/identification/neighbour_leakage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/identification/mac.h"
#include "core/identification/stabilisation.h"
#include "core/types/constants.h"

namespace core {
namespace {

using Complex = std::complex<double>;
using Shape = std::vector<Complex>;

constexpr double kRate = 25.0, kZeta = 0.01;
const Shape kWeak{0.47, -0.83, 1.0, -0.94, 0.67, -0.24}, kStrong{1.0, -0.24, -0.94, 0.47, 0.83, -0.67};

FoldingConfig six_rows(double readout_s) {
  FoldingConfig config{kRate, 16.0, {}};
  for (std::size_t c = 0; c < kWeak.size(); ++c)
    config.delay_s.push_back(readout_s * (0.9 - 0.15 * static_cast<double>(c)));
  return config;
}

DiscretePole observe(double frequency_hz, const Shape& shape, const FoldingConfig& config) {
  const double w = kTwoPi * frequency_hz;
  const Complex s(-kZeta * w, w * std::sqrt(1.0 - kZeta * kZeta));
  DiscretePole pole{std::exp(s / kRate), shape, 0.5};
  for (std::size_t c = 0; c < shape.size(); ++c) pole.shape[c] *= std::exp(s * config.delay_s[c]);
  if (pole.lambda.imag() < 0.0) {
    pole.lambda = std::conj(pole.lambda);
    for (Complex& z : pole.shape) z = std::conj(z);
  }
  return pole;
}

// A mode of 14.34 Hz, which folds to 10.66 Hz, beside one of 10.83 Hz that leaks into it.
std::vector<DiscretePole> mixed(const FoldingConfig& config, Complex leak) {
  std::vector<DiscretePole> poles{observe(10.83, kStrong, config), observe(14.34, kWeak, config)};
  for (std::size_t c = 0; c < kWeak.size(); ++c) poles[1].shape[c] += leak * poles[0].shape[c];
  return poles;
}

UnfoldedOrder unfolded(const std::vector<DiscretePole>& poles, const FoldingConfig& config) {
  std::vector<Shape> shapes;
  for (const DiscretePole& pole : poles) shapes.push_back(pole.shape);
  return unfold_order(poles, shapes, config);
}

TEST(NeighbourLeakage, RemovesWhatLeaksFromAModeBeside) {
  const FoldingConfig config = six_rows(0.6 / kRate);
  const auto poles = mixed(config, {-0.4, 0.45});
  EXPECT_LT(unfold(poles[1].lambda, poles[1].shape, config).mpc, 0.7) << "what is to be mended";
  const UnfoldedOrder order = unfolded(poles, config);
  ASSERT_TRUE(order.leaks[1].has_value());
  EXPECT_EQ(order.poles[1].fold_n, -1);
  EXPECT_GT(order.poles[1].mpc, 0.99);
  EXPECT_GT(*order.poles[1].fold_margin, 0.3);
  EXPECT_GT(mac(order.poles[1].shape, kWeak), 0.999);
  EXPECT_NEAR(frequency_hz(order.poles[1].s), 14.34, 1e-9);
  EXPECT_FALSE(order.leaks[0].has_value()) << "the better defined shape stays as it is";
  EXPECT_EQ(order.poles[0].emac, 0.5);
}

TEST(NeighbourLeakage, LeavesAShapeThatNeedsNothing) {
  const FoldingConfig config = six_rows(0.6 / kRate);
  const auto poles = mixed(config, 0.0);
  const UnfoldedOrder order = unfolded(poles, config);
  EXPECT_GT(mac(order.poles[1].shape, kWeak), 1.0 - 1e-6);
  EXPECT_EQ(order.poles[1].fold_n, -1);
}

TEST(NeighbourLeakage, NeedsANeighbourWithinReach) {
  const FoldingConfig config = six_rows(0.6 / kRate);
  std::vector<DiscretePole> poles{observe(8.14, kStrong, config), observe(14.34, kWeak, config)};
  for (std::size_t c = 0; c < kWeak.size(); ++c) poles[1].shape[c] += Complex(-0.4, 0.45) * poles[0].shape[c];
  EXPECT_FALSE(unfolded(poles, config).leaks[1].has_value());
}

// A neighbour with the same alias order is seen with the same delays: nothing distinguishes its part.
TEST(NeighbourLeakage, DoesNothingBetweenModesOfOneAliasOrder) {
  const FoldingConfig config = six_rows(0.6 / kRate);
  std::vector<DiscretePole> poles{observe(10.83, kStrong, config), observe(10.66, kWeak, config)};
  for (std::size_t c = 0; c < kWeak.size(); ++c) poles[1].shape[c] += 0.5 * poles[0].shape[c];
  const UnfoldedOrder order = unfolded(poles, config);
  EXPECT_EQ(order.poles[1].fold_n, 0);
}

// Noise is seldom in phase after the fit: MPC reduced by the parameters fitted.
TEST(NeighbourLeakage, SeldomMakesAModeOfNoise) {
  const FoldingConfig config = six_rows(0.6 / kRate);
  std::mt19937 random(1);
  std::normal_distribution<double> gaussian;
  int n_in_phase = 0;
  for (int k = 0; k < 200; ++k) {
    Shape noise;
    for (std::size_t c = 0; c < kWeak.size(); ++c) noise.emplace_back(gaussian(random), gaussian(random));
    std::vector<DiscretePole> poles{observe(10.83, kStrong, config), observe(14.34, kWeak, config)};
    poles[1].shape = noise;
    n_in_phase += unfolded(poles, config).poles[1].mpc > 0.8 ? 1 : 0;
  }
  EXPECT_LT(n_in_phase, 30);
}

// The removal is linear over the real numbers, as standard deviations need it.
TEST(NeighbourLeakage, IsLinear) {
  const FoldingConfig config = six_rows(0.6 / kRate);
  const auto poles = mixed(config, {-0.4, 0.45});
  const UnfoldedOrder order = unfolded(poles, config);
  ASSERT_TRUE(order.leaks[1].has_value());
  Shape sum = poles[1].shape;
  for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += 0.1 * kWeak[c];
  const Shape a = order.leaks[1]->without(poles[1].shape), b = order.leaks[1]->without(kWeak),
              both = order.leaks[1]->without(sum);
  for (std::size_t c = 0; c < sum.size(); ++c) EXPECT_NEAR(std::abs(both[c] - a[c] - 0.1 * b[c]), 0.0, 1e-12);
}

}  // namespace
}  // namespace core
