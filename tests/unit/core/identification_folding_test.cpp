#include "core/identification/folding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/identification/mac.h"

namespace core {
namespace {

using Complex = std::complex<double>;
constexpr double kRate = 25.0;
constexpr double kZeta = 0.01;

const std::vector<Complex> kShape{0.3, 0.7, 1.0, -0.4, -0.9, 0.5};

FoldingConfig seven_rows(double readout_s, double max_frequency_hz) {
  FoldingConfig config{kRate, max_frequency_hz, {}};
  for (std::size_t c = 0; c < kShape.size(); ++c)
    config.delay_s.push_back(readout_s * (0.1 + 0.15 * static_cast<double>(c)));
  return config;
}

struct Seen {
  Complex lambda;
  std::vector<Complex> shape;
};

// A mode of the given true frequency as sampled at kRate: the pole of the upper half plane after aliasing.
Seen observe(double frequency_hz, const std::vector<double>& delay_s) {
  const double w = 2.0 * std::numbers::pi * frequency_hz;
  const Complex s(-kZeta * w, w * std::sqrt(1.0 - kZeta * kZeta));
  Seen seen{std::exp(s / kRate), kShape};
  for (std::size_t c = 0; c < kShape.size(); ++c) seen.shape[c] *= Complex(0.4, -1.3) * std::exp(s * delay_s[c]);
  if (seen.lambda.imag() < 0.0) {
    seen.lambda = std::conj(seen.lambda);
    for (Complex& z : seen.shape) z = std::conj(z);
  }
  return seen;
}

TEST(Folding, StatesTheFrequenciesThatTheSamplesDoNotExclude) {
  // Rows read simultaneously: no delay shows the alias order.
  FoldingConfig blind{kRate, 0.0, std::vector<double>(kShape.size(), 0.0)};
  const Seen seen = observe(3.0, blind.delay_s);
  const std::vector<double> others = other_frequencies(unfold(seen.lambda, seen.shape, blind), blind, 0.3);
  ASSERT_EQ(others.size(), 4U);
  const std::vector<double> wanted{22.0, 28.0, 47.0, 53.0};
  for (std::size_t i = 0; i < others.size(); ++i) EXPECT_NEAR(others[i], wanted[i], 0.02);
  // Declared: nothing above half the rate.
  blind.max_frequency_hz = 12.0;
  EXPECT_TRUE(other_frequencies(unfold(seen.lambda, seen.shape, blind), blind, 0.3).empty());
  // Row delays exclude them, although the alias order was not requested.
  const FoldingConfig rows = seven_rows(0.9 / kRate, 0.0);
  const Seen rolled = observe(3.0, rows.delay_s);
  EXPECT_TRUE(other_frequencies(unfold(rolled.lambda, rolled.shape, rows), rows, 0.3).empty());
}

TEST(Folding, RecoversEveryFold) {
  const FoldingConfig config = seven_rows(0.9 / kRate, 60.0);
  const struct {
    double true_hz, apparent_hz;
    int n;
  } cases[] = {{3.0, 3.0, 0},   {12.93, 12.07, -1}, {14.34, 10.66, -1}, {27.0, 2.0, 1},
               {36.0, 11.0, 1}, {40.0, 10.0, -2},   {55.0, 5.0, 2}};
  for (const auto& c : cases) {
    const Seen seen = observe(c.true_hz, config.delay_s);
    const UnfoldedPole pole = unfold(seen.lambda, seen.shape, config);
    ASSERT_TRUE(pole.fold_n.has_value()) << c.true_hz;
    EXPECT_EQ(*pole.fold_n, c.n) << c.true_hz;
    EXPECT_NEAR(pole.apparent_hz, c.apparent_hz, 0.02) << c.true_hz;
    EXPECT_NEAR(std::abs(pole.s) / (2.0 * std::numbers::pi), c.true_hz, 1e-9);
    EXPECT_NEAR(-pole.s.real() / std::abs(pole.s), kZeta, 1e-9);
    EXPECT_GT(pole.s.imag(), 0.0);
    EXPECT_NEAR(pole.mpc, 1.0, 1e-9);
    EXPECT_GT(mac(pole.shape, kShape), 1.0 - 1e-9);
    EXPECT_GT(*pole.fold_margin, 0.05) << c.true_hz;
  }
}

TEST(Folding, LooksNoFurtherThanItIsTold) {
  const FoldingConfig wide = seven_rows(0.9 / kRate, 60.0);
  const Seen seen = observe(40.0, wide.delay_s);
  const UnfoldedPole pole = unfold(seen.lambda, seen.shape, seven_rows(0.9 / kRate, 20.0));
  ASSERT_TRUE(pole.fold_n.has_value());
  EXPECT_NE(*pole.fold_n, -2);
  EXPECT_LT(std::abs(pole.s) / (2.0 * std::numbers::pi), 20.0);
  EXPECT_LT(pole.mpc, 0.9);
}

TEST(Folding, BelowHalfTheRateNothingIsUnfolded) {
  const FoldingConfig config = seven_rows(0.9 / kRate, kRate / 2.0);
  const Seen seen = observe(3.0, config.delay_s);
  const UnfoldedPole pole = unfold(seen.lambda, seen.shape, config);
  EXPECT_FALSE(pole.fold_n.has_value());
  EXPECT_FALSE(pole.fold_margin.has_value());
  EXPECT_NEAR(pole.mpc, 1.0, 1e-9) << "the delays are undone all the same";
}

TEST(Folding, IsNotObservableWithFewerThanThreeChannels) {
  FoldingConfig two = seven_rows(0.9 / kRate, 60.0);
  two.delay_s.resize(2);
  EXPECT_FALSE(folding_observable(two));
  const Seen seen = observe(14.34, seven_rows(0.9 / kRate, 60.0).delay_s);
  const UnfoldedPole pole = unfold(seen.lambda, {seen.shape[0], seen.shape[1]}, two);
  EXPECT_FALSE(pole.fold_n.has_value());
  EXPECT_NEAR(pole.apparent_hz, 10.66, 0.02);
}

TEST(Folding, IsOpenWhereOtherFrequenciesCannotBeTold) {
  FoldingConfig two = seven_rows(0.9 / kRate, 20.0);
  const Seen seen = observe(14.34, two.delay_s);
  EXPECT_FALSE(unfold(seen.lambda, seen.shape, two).fold_open) << "six channels tell it";
  two.delay_s.resize(2);
  const UnfoldedPole open = unfold(seen.lambda, {seen.shape[0], seen.shape[1]}, two);
  EXPECT_TRUE(open.fold_open);
  EXPECT_GT(open.mpc, 0.999) << "that of the best hypothesis";
  const Seen slow = observe(2.0, two.delay_s);  // 23 and 27 Hz are not searched
  EXPECT_FALSE(unfold(slow.lambda, {slow.shape[0], slow.shape[1]}, two).fold_open);
}

TEST(Folding, GivesTheObservedShapeBack) {
  const FoldingConfig config = seven_rows(0.9 / kRate, 60.0);
  for (const double true_hz : {3.0, 14.34, 27.0, 40.0}) {
    const Seen seen = observe(true_hz, config.delay_s);
    const std::vector<Complex> shape = observed_shape(unfold(seen.lambda, seen.shape, config), config);
    EXPECT_NEAR(mac(shape, seen.shape), 1.0, 1e-12) << true_hz;
  }
}

TEST(Folding, IsNotObservableWithoutDelays) {
  EXPECT_TRUE(folding_observable(seven_rows(0.9 / kRate, 60.0)));
  EXPECT_FALSE(folding_observable(seven_rows(0.0, 60.0)));
  const FoldingConfig global = seven_rows(0.0, 60.0);
  const Seen seen = observe(14.34, global.delay_s);
  EXPECT_FALSE(unfold(seen.lambda, seen.shape, global).fold_n.has_value());
}

TEST(NormaliseShape, MakesTheLargestComponentOne) {
  std::vector<Complex> shape{{0.0, 1.0}, {3.0, 4.0}, {-1.0, 0.0}};
  normalise_shape(shape);
  EXPECT_EQ(shape[1], Complex(1.0, 0.0));
  EXPECT_NEAR(std::abs(shape[0] - Complex(4.0, 3.0) / 25.0), 0.0, 1e-15);
  std::vector<Complex> zero(3);
  normalise_shape(zero);
  for (const Complex& z : zero) EXPECT_EQ(z, 0.0);
}

// A velocity is s times, an acceleration s^2 times the displacement: undamped, the shape rotates by 90 degrees for
// each.
TEST(Folding, MixedQuantitiesBecomeDisplacements) {
  FoldingConfig config = seven_rows(0.0, kRate / 2.0);
  config.n_integrations = {0, 1, 2, 2, 1, 0};
  Seen seen = observe(3.0, config.delay_s);
  const double w = 2.0 * std::numbers::pi * 3.0;
  const Complex s(-kZeta * w, w * std::sqrt(1.0 - kZeta * kZeta));
  for (std::size_t c = 0; c < seen.shape.size(); ++c) seen.shape[c] *= std::pow(s, config.n_integrations[c]);
  const UnfoldedPole pole = unfold(seen.lambda, seen.shape, config);
  EXPECT_NEAR(pole.mpc, 1.0, 1e-9);
  EXPECT_NEAR(mac(pole.shape, kShape), 1.0, 1e-9);
  config.n_integrations.clear();
  EXPECT_LT(mac(unfold(seen.lambda, seen.shape, config).shape, kShape), 0.9);
}

// An aliased shape is divided by powers of the true frequency, not of the apparent one.
TEST(Folding, MixedQuantitiesOfAFoldedModeAreDividedByItsTrueFrequency) {
  FoldingConfig config = seven_rows(0.9 / kRate, 20.0);
  config.n_integrations = {0, 2, 0, 2, 0, 2};
  const double w = 2.0 * std::numbers::pi * 14.34;
  const Complex s(-kZeta * w, w * std::sqrt(1.0 - kZeta * kZeta));
  Seen seen{std::exp(s / kRate), kShape};
  for (std::size_t c = 0; c < kShape.size(); ++c)
    seen.shape[c] *= std::pow(s, config.n_integrations[c]) * std::exp(s * config.delay_s[c]);
  seen.lambda = std::conj(seen.lambda);  // 14.34 - 25 Hz is the upper half plane's conjugate
  for (Complex& z : seen.shape) z = std::conj(z);
  const UnfoldedPole pole = unfold(seen.lambda, seen.shape, config);
  ASSERT_TRUE(pole.fold_n.has_value());
  EXPECT_EQ(*pole.fold_n, -1);
  EXPECT_NEAR(mac(pole.shape, kShape), 1.0, 1e-9);
}

}  // namespace
}  // namespace core
