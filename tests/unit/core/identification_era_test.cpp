#include "core/identification/era.h"

#include <gtest/gtest.h>

#include "core/identification/block_hankel.h"
#include "core/identification/mac.h"
#include "tests/support/random_system.h"

namespace core {
namespace {

using test_support::RandomSystem;

EraConfig config_of(int block_rows, std::vector<int> references, bool canonical_variates) {
  EraConfig config;
  config.block_rows = block_rows;
  config.references = std::move(references);
  config.canonical_variates = canonical_variates;
  return config;
}

TEST(Era, OrderTwoFindsTheOnlyModeOfASystem) {
  const RandomSystem system(1, 1, 2);
  Realisation realisation;
  ASSERT_EQ(realise(system.correlations(30), config_of(8, {0, 1}, true), realisation), EraStatus::kOk);
  const std::vector<DiscretePole> poles = poles_of_order(realisation, 2);
  ASSERT_EQ(poles.size(), 1U);
  EXPECT_LT(std::abs(poles[0].lambda - system.poles[0].lambda), 1e-9);
  EXPECT_GT(mac(poles[0].shape, system.poles[0].shape), 1.0 - 1e-9);
}

TEST(Era, ShapesAreInChannelUnits) {
  const RandomSystem system(2, 2, 3);
  Correlations scaled = system.correlations(30);
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      for (int lag = -30; lag <= 30; ++lag) {
        const double factor = (i == 1 ? 1000.0 : 1.0) * (j == 1 ? 1000.0 : 1.0);
        scaled.set(i, j, lag, factor * scaled.divided(i, j, lag), factor * scaled.undivided(i, j, lag));
      }
    }
  }
  Realisation realisation;
  ASSERT_EQ(realise(scaled, config_of(10, {0, 1, 2}, true), realisation), EraStatus::kOk);
  for (const DiscretePole& pole : poles_of_order(realisation, 4)) {
    for (const RandomSystem::Pole& truth : system.poles) {
      if (std::abs(pole.lambda - truth.lambda) > 1e-6) continue;
      EXPECT_NEAR(std::abs(pole.shape[1] / pole.shape[0]), 1000.0 * std::abs(truth.shape[1] / truth.shape[0]),
                  1e-3 * 1000.0);
    }
  }
}

TEST(Era, CanonicalCorrelationsLieBetweenZeroAndOneAndShowTheOrder) {
  const RandomSystem system(5, 3, 4);
  Realisation realisation;
  ASSERT_EQ(realise(system.correlations(40), config_of(12, {0, 1, 2, 3}, true), realisation), EraStatus::kOk);
  EXPECT_LE(realisation.singular_values.maxCoeff(), 1.0 + 1e-6);
  EXPECT_LT(realisation.singular_values[6], 0.01);
  EXPECT_LE(canonical_order(realisation), 6);
  EXPECT_EQ(canonical_order(realisation, 0.01), 6);
}

TEST(Era, MapsTakeTheHankelMatricesToTheRealisation) {
  const RandomSystem system(4, 3, 3);
  const Correlations correlations = system.correlations(30);
  Eigen::VectorXd scale(3);
  for (int i = 0; i < 3; ++i) scale[i] = std::sqrt(correlations.undivided(i, i, 0));
  for (const bool weighted : {false, true}) {
    EraConfig config = config_of(10, {0, 2}, weighted);
    config.max_order = 6;
    Realisation realisation;
    ASSERT_EQ(realise(correlations, config, realisation), EraStatus::kOk);
    const auto mapped = [&](int first_lag) -> Eigen::MatrixXd {
      return realisation.left_map * block_hankel(correlations, config.references, scale, 10, 10, first_lag) *
             realisation.right_map;
    };
    EXPECT_LT((mapped(config.first_lag) - Eigen::MatrixXd::Identity(6, 6)).norm(), 1e-6) << weighted;
    EXPECT_LT((mapped(config.first_lag + 1) - realisation.a).norm(), 1e-6 * realisation.a.norm()) << weighted;
  }
}

TEST(Era, SaysWhenThereAreTooFewLags) {
  const RandomSystem system(1, 1, 2);
  Realisation realisation;
  EXPECT_EQ(realise(system.correlations(16), config_of(8, {0, 1}, true), realisation), EraStatus::kTooFewLags);
}

TEST(Era, SaysWhenThereIsNoSystem) {
  Correlations white(2, 30);  // white noise: nothing beyond lag 0
  for (int c = 0; c < 2; ++c) white.set(c, c, 0, 1.0, 1.0);
  Realisation realisation;
  for (const bool weighted : {false, true}) {
    EXPECT_EQ(realise(white, config_of(8, {0, 1}, weighted), realisation), EraStatus::kRankDeficient);
  }
}

TEST(Era, NaNInTheCorrelationsIsAStatus) {
  Correlations correlations = RandomSystem(1, 1, 2).correlations(30);
  correlations.set(0, 1, 5, std::numeric_limits<double>::quiet_NaN(), 0.0);
  Realisation realisation;
  for (const bool weighted : {false, true}) {
    EXPECT_EQ(realise(correlations, config_of(8, {0, 1}, weighted), realisation), EraStatus::kRankDeficient);
  }
}

TEST(Era, AsksForNoMoreThanTheRealisationHolds) {
  const RandomSystem system(1, 1, 2);
  Realisation realisation;
  ASSERT_EQ(realise(system.correlations(30), config_of(8, {0}, true), realisation), EraStatus::kOk);
  EXPECT_LE(static_cast<Eigen::Index>(poles_of_order(realisation, 1000).size()), realisation.a.rows());
  EXPECT_TRUE(poles_of_order(realisation, 1).empty()) << "one real pole has no upper half plane";
}

}  // namespace
}  // namespace core
