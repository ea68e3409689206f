#include "core/identification/combine_estimates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <random>

namespace core {
namespace {

using Shape = std::vector<std::complex<double>>;

struct Given {
  double hz = 0.0, hz_std = 0.0, damping = 0.01, damping_std = 0.001;  // std 0: not stated
  Shape shape{1.0, 0.5, -0.2};
};

Mode mode(const Given& given) {
  Mode out;
  out.frequency_hz = given.hz;
  if (given.hz_std > 0.0) out.frequency_std_hz = given.hz_std;
  out.damping_ratio = given.damping;
  if (given.damping_std > 0.0) out.damping_std = given.damping_std;
  out.shape = given.shape;
  return out;
}

ModalEstimate estimate(const std::vector<Given>& modes, double duration_s = 100.0) {
  ModalEstimate out;
  out.duration_s = duration_s;
  out.degrees_of_freedom = 9.0;
  for (const Given& one : modes) out.modes.push_back(mode(one));
  return out;
}

const std::vector<std::string> kNames{"low", "middle", "top"};

std::vector<EstimateInput> inputs(const std::vector<ModalEstimate>& estimates) {
  std::vector<EstimateInput> out;
  for (const ModalEstimate& one : estimates) out.push_back({kNames, &one, true});
  return out;
}

TEST(CombineEstimates, MatchesByFrequencyAndShape) {
  const Shape bending{1.0, 0.5, -0.2}, torsion{1.0, -0.9, 0.8};
  // Two modes as close to each other as the estimates of one mode in two flights: their shapes distinguish them.
  const std::vector<ModalEstimate> flights{
      estimate({{2.00, 0.01, 0.01, 0.001, bending}, {2.03, 0.01, 0.02, 0.001, torsion}}),
      estimate({{2.01, 0.01, 0.02, 0.001, torsion}, {2.02, 0.01, 0.01, 0.001, bending}, {7.0, 0.1}})};
  const auto groups = combine_estimates(inputs(flights));
  ASSERT_EQ(groups.size(), 3U);
  EXPECT_NEAR(groups[0].damping_ratio.value, 0.01, 1e-9);
  EXPECT_NEAR(groups[1].damping_ratio.value, 0.02, 1e-9);
  EXPECT_EQ(groups[2].members.size(), 1U);
}

TEST(CombineEstimates, NeverJoinsTwoModesOfOneFlight) {
  const std::vector<ModalEstimate> flights{estimate({{2.00, 0.01}, {2.01, 0.01}}), estimate({{2.005, 0.01}})};
  for (const ModeGroup& group : combine_estimates(inputs(flights))) {
    for (std::size_t i = 1; i < group.members.size(); ++i)
      EXPECT_LT(group.members[i - 1].i_estimate, group.members[i].i_estimate);
  }
}

TEST(CombineEstimates, NeedsNoCommonChannels) {
  const std::vector<ModalEstimate> flights{estimate({{2.00, 0.01}}), estimate({{2.01, 0.01, 0.01, 0.001, {0.1, 1.0}}})};
  std::vector<EstimateInput> given = inputs(flights);
  given[1].channels = {"top", "elsewhere"};  // one in common: no shape to compare
  ASSERT_EQ(combine_estimates(given).size(), 1U);
  EXPECT_NEAR(combine_estimates(given)[0].frequency_hz.value, 2.005, 1e-12);
}

TEST(CombineEstimates, DoesNotDependOnTheOrderOfFlights) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<ModalEstimate> flights;
  for (int f = 0; f < 12; ++f) {
    std::vector<Given> modes;
    for (const double hz : {1.6, 5.0, 8.2}) {
      const double std = 0.003 * hz * (1.0 + 0.3 * std::abs(normal(random)));
      modes.push_back({hz + std * normal(random), std, 0.01 * std::exp(0.2 * normal(random)), 0.002});
    }
    flights.push_back(estimate(modes));
  }
  const auto once = combine_estimates(inputs(flights));
  ASSERT_EQ(once.size(), 3U);
  for (int trial = 0; trial < 5; ++trial) {
    std::shuffle(flights.begin(), flights.end(), random);
    const auto again = combine_estimates(inputs(flights));
    ASSERT_EQ(again.size(), once.size());
    for (std::size_t g = 0; g < once.size(); ++g) {
      EXPECT_EQ(again[g].members.size(), 12U);
      EXPECT_NEAR(again[g].frequency_hz.value, once[g].frequency_hz.value, 1e-13 * once[g].frequency_hz.value);
      EXPECT_NEAR(again[g].frequency_hz.std, once[g].frequency_hz.std, 1e-12 * once[g].frequency_hz.std);
      EXPECT_NEAR(again[g].damping_ratio.value, once[g].damping_ratio.value, 1e-12 * once[g].damping_ratio.value);
    }
  }
}

TEST(CombineEstimates, WhatIsNotCombinedOnlyTakesPartInTheMatching) {
  const std::vector<ModalEstimate> flights{estimate({{2.00, 0.01}}), estimate({{2.02, 0.01}, {5.0, 0.01}})};
  std::vector<EstimateInput> given = inputs(flights);
  given[1].is_combined = false;
  const auto groups = combine_estimates(given);
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0].members.size(), 2U);
  EXPECT_EQ(groups[0].frequency_hz.value, 2.00);
  EXPECT_EQ(groups[1].frequency_hz.n, 0U);
}

TEST(CombineEstimates, WithoutDeviationsWeighsByDurationAndStatesNone) {
  const std::vector<ModalEstimate> flights{estimate({{2.00, 0.0}}, 100.0), estimate({{2.03, 0.0}}, 200.0)};
  const auto groups = combine_estimates(inputs(flights));
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_NEAR(groups[0].frequency_hz.value, 2.02, 1e-12);
  EXPECT_EQ(groups[0].frequency_hz.std, 0.0);
  EXPECT_EQ(groups[0].frequency_hz.n, 2U);
}

// A sigma proportional to the square root of the damping, as for a record of given length: the mean is not biased by
// values that are low by chance and therefore state a small sigma.
TEST(CombineEstimates, DampingIsNotDrawnDownByLowValues) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  double sum = 0.0;
  constexpr int kTrials = 2000;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<ModalEstimate> flights;
    for (int f = 0; f < 8; ++f) {
      const double damping = std::max(0.002, 0.01 * (1.0 + 0.25 * normal(random)));
      flights.push_back(estimate({{2.0, 0.01, damping, 0.0025 * std::sqrt(damping / 0.01)}}));
    }
    sum += combine_estimates(inputs(flights)).at(0).damping_ratio.value;
  }
  EXPECT_NEAR(sum / kTrials, 0.01, 0.0004);
}

}  // namespace
}  // namespace core
