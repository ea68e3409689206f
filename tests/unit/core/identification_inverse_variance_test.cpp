#include "core/identification/inverse_variance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace core {
namespace {

TEST(InverseVarianceMean, WeighsByPrecision) {
  const std::vector<Measured> two{{10.0, 1.0, 0.0}, {13.0, 2.0, 0.0}};
  const WeightedMean mean = inverse_variance_mean(two);
  EXPECT_NEAR(mean.value, (10.0 * 4.0 + 13.0) / 5.0, 1e-14);
  // chi^2 = 9 / 5 with one degree of freedom: they scatter 1.34 times as far as stated.
  ASSERT_TRUE(mean.scatter);
  EXPECT_NEAR(*mean.scatter, std::sqrt(9.0 / 5.0), 1e-14);
  EXPECT_NEAR(mean.std, std::sqrt(4.0 / 5.0) * std::sqrt(9.0 / 5.0), 1e-14);
}

TEST(InverseVarianceMean, OfOneIsItself) {
  const WeightedMean mean = inverse_variance_mean(std::vector<Measured>{{0.1, 0.03, 9.0}});
  EXPECT_EQ(mean.value, 0.1);
  EXPECT_EQ(mean.std, 0.03);
  EXPECT_DOUBLE_EQ(mean.degrees_of_freedom, 9.0);
  EXPECT_FALSE(mean.scatter);
}

TEST(InverseVarianceMean, OfNoneIsNothing) { EXPECT_EQ(inverse_variance_mean({}).n, 0U); }

// Sigmas estimated from ten parts, as stated by a record: the sum of the weights alone gives a variance of two
// thirds of the mean's true one; Meier's first order is accurate within a tenth.
TEST(InverseVarianceMean, PaysForWeightsThatAreEstimates) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::chi_squared_distribution<double> chi_squared(9.0);
  constexpr int kTrials = 20000, kFlights = 6;
  double squares = 0.0, stated = 0.0, naive = 0.0, scatter = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<Measured> flights;
    for (int f = 0; f < kFlights; ++f) flights.push_back({normal(random), std::sqrt(chi_squared(random) / 9.0), 9.0});
    const WeightedMean mean = inverse_variance_mean(flights);
    squares += mean.value * mean.value;
    const double own = mean.std / std::max(1.0, *mean.scatter);  // without Birge's factor, which only increases it
    stated += own * own;
    double total = 0.0;
    for (const Measured& m : flights) total += 1.0 / (m.std * m.std);
    naive += 1.0 / total;
    scatter += *mean.scatter * *mean.scatter;
  }
  EXPECT_NEAR(stated / squares, 0.9, 0.05);
  EXPECT_LT(naive / squares, 0.72);
  EXPECT_NEAR(scatter / kTrials, 1.0, 0.1);
}

TEST(InverseVarianceMean, WidensWhereTheyDisagree) {
  const std::vector<Measured> agree{{1.0, 0.1, 9.0}, {1.05, 0.1, 9.0}, {0.95, 0.1, 9.0}};
  std::vector<Measured> disagree = agree;
  disagree[2].value = 2.0;
  EXPECT_LT(*inverse_variance_mean(agree).scatter, 1.0);
  EXPECT_GT(*inverse_variance_mean(disagree).scatter, 3.0);
  EXPECT_GT(inverse_variance_mean(disagree).std, 3.0 * inverse_variance_mean(agree).std);
}

}  // namespace
}  // namespace core
