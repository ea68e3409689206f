#include "core/identification/block_deviations.h"

#include <gtest/gtest.h>

#include <random>

#include "core/identification/correlation.h"
#include "core/spectrum/welch_cpsd.h"

namespace core {
namespace {

CpsdSums record(double loss, double forget_s = 0.0) {
  WelchConfig config;
  config.n_channels = 3;
  config.segment = 64;
  config.rate_hz = 25.0;
  config.forget_s = forget_s;
  WelchCpsd welch(config);
  std::mt19937 random(7);
  std::normal_distribution<double> gaussian;
  std::uniform_real_distribution<double> uniform;
  double slow = 0.0;
  for (int t = 0; t < 4000; ++t) {
    slow = 0.9 * slow + gaussian(random);
    const std::vector<double> value{slow, 0.5 * slow + gaussian(random), gaussian(random)};
    std::vector<std::uint8_t> seen(3);
    for (auto& s : seen) s = uniform(random) >= loss ? 1 : 0;
    welch.push(value, seen);
  }
  return welch.sums();
}

// R of the record in which one part counts 1 + eps, lag by lag.
Correlations with_part(CpsdSums sums, std::size_t first, std::size_t last, double eps) {
  for (std::size_t b = first; b < last; ++b) {
    for (std::size_t k = 0; k < sums.data_sum.size(); ++k) {
      sums.data_sum[k] += eps * sums.blocks[b].data_sum[k];
      sums.mask_sum[k] += eps * sums.blocks[b].mask_sum[k];
    }
  }
  Correlations out;
  EXPECT_EQ(compute_correlations(sums, 20, 1, out), CorrelationStatus::kOk);
  return out;
}

TEST(BlockDeviations, AreTheDerivativesOfTheCorrelations) {
  for (const double loss : {0.0, 0.2}) {
    const CpsdSums sums = record(loss);
    ASSERT_GE(sums.n_blocks, 10U);
    const std::vector<int> references{2, 0};
    const BlockDeviations deviations = block_deviations(sums, references, {2, 12, 1}, 10);
    ASSERT_EQ(deviations.n_blocks, 10);
    ASSERT_EQ(deviations.value.rows(), 30);
    ASSERT_EQ(deviations.value.cols(), 24);
    const double eps = 1e-6;
    const Correlations before = with_part(sums, 0, 0, eps);
    for (const std::size_t group : {0U, 4U, 9U}) {
      const Correlations after = with_part(sums, group * sums.n_blocks / 10, (group + 1) * sums.n_blocks / 10, eps);
      for (int channel = 0; channel < 3; ++channel) {
        for (int k = 0; k < 12; ++k) {
          for (int r = 0; r < 2; ++r) {
            const int lag = 2 + k, reference = references[static_cast<std::size_t>(r)];
            const double slope =
                (after.divided(channel, reference, lag) - before.divided(channel, reference, lag)) / eps;
            EXPECT_NEAR(deviations.value(static_cast<Eigen::Index>(group) * 3 + channel, 2 * k + r), slope, 2e-5)
                << loss << " " << group << " " << channel << " " << lag;
          }
        }
      }
    }
  }
}

TEST(BlockDeviations, AddUpToZero) {
  const BlockDeviations deviations = block_deviations(record(0.1), {0, 1, 2}, {1, 10, 0}, 10);
  for (Eigen::Index c = 0; c < 3; ++c) {
    double sum = 0.0;
    for (Eigen::Index b = 0; b < 10; ++b) sum += deviations.value(3 * b + c, 7);
    EXPECT_NEAR(sum, 0.0, 1e-12);
  }
}

TEST(BlockDeviations, HaveOneDegreeOfFreedomLessThanPartsAndFewerWhereTheyWeighLess) {
  EXPECT_NEAR(block_deviations(record(0.0), {0}, {1, 4, 0}, 10).degrees_of_freedom, 9.0, 1.0);
  const double forgetting = block_deviations(record(0.0, 30.0), {0}, {1, 4, 0}, 10).degrees_of_freedom;
  EXPECT_GT(forgetting, 2.0);
  EXPECT_LT(forgetting, 7.0);
}

TEST(BlockDeviations, AreNoneWithTooFewBlocks) {
  CpsdSums sums = record(0.0);
  sums.n_blocks = 9;
  EXPECT_EQ(block_deviations(sums, {0}, {1, 4, 0}, 10).n_blocks, 0);
}

}  // namespace
}  // namespace core
