#include "core/identification/uncertainty.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "core/identification/identifier.h"
#include "tests/support/mixed_correlations.h"
#include "tests/support/random_system.h"
#include "tests/support/simulated_structure.h"

namespace core {
namespace {

using Complex = std::complex<double>;
using test_support::mixed_correlations;
using test_support::RandomSystem;
using test_support::SimulatedStructure;

EraConfig plain(int n_channels, int order) {
  EraConfig config;
  config.block_rows = 12;
  config.max_order = order;
  config.canonical_variates = false;
  for (int c = 0; c < n_channels; ++c) config.references.push_back(c);
  return config;
}

const DiscretePole& nearest(const std::vector<DiscretePole>& poles, Complex lambda) {
  return *std::min_element(poles.begin(), poles.end(), [&](const auto& a, const auto& b) {
    return std::abs(a.lambda - lambda) < std::abs(b.lambda - lambda);
  });
}

// The functional is the derivative: the pole refitted from slightly changed correlations has moved as predicted. The
// system fills the subspace exactly, so that a fixed subspace is correct to first order.
TEST(PoleChanges, AreTheDerivativeOfARefit) {
  constexpr int kModes = 3, kOrder = 2 * kModes;
  const RandomSystem system(4, kModes, 4), other(5, kModes, 4);
  const EraConfig config = plain(4, kOrder);
  const Correlations r = system.correlations(40), s = other.correlations(40);
  Realisation at;
  ASSERT_EQ(realise(r, config, at), EraStatus::kOk);
  const double eps = 1e-6;
  const int n_lags = 2 * config.block_rows;
  BlockDeviations deviation{1, 0.0, Eigen::MatrixXd(4, 4 * n_lags)};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < n_lags; ++k) {
        const int lag = config.first_lag + k;
        deviation.value(i, 4 * k + j) = s.divided(i, j, lag) - r.divided(i, j, lag);
      }
    }
  }
  std::vector<PoleOfOrder> poles;
  for (const DiscretePole& pole : poles_of_order(at, kOrder)) poles.push_back({kOrder, pole});
  ASSERT_EQ(poles.size(), 3U);
  const auto changes = pole_changes(at, config, deviation, poles);
  Realisation moved;
  ASSERT_EQ(realise(mixed_correlations(r, s, eps), config, moved), EraStatus::kOk);
  const std::vector<DiscretePole> later = poles_of_order(moved, kOrder);
  for (std::size_t p = 0; p < poles.size(); ++p) {
    ASSERT_EQ(changes[p].size(), 1U);
    const DiscretePole& before = poles[p].pole;
    const DiscretePole& after = nearest(later, before.lambda);
    const Complex slope = (after.lambda - before.lambda) / eps;
    EXPECT_NEAR(std::abs(changes[p][0].lambda - slope), 0.0, 1e-3 * std::abs(slope));
    // Shapes have no scale: the ratio to the first component is compared.
    for (std::size_t c = 1; c < before.shape.size(); ++c) {
      const Complex ratio = before.shape[c] / before.shape[0];
      const Complex ratio_slope = (after.shape[c] / after.shape[0] - ratio) / eps;
      const Complex stated = (changes[p][0].shape[c] - ratio * changes[p][0].shape[0]) / before.shape[0];
      EXPECT_NEAR(std::abs(stated - ratio_slope), 0.0, 1e-2 * (1.0 + std::abs(ratio_slope))) << c;
    }
  }
}

TEST(ModeScatter, IsStatedFromTwoBlocksOnWithTheirDegreesOfFreedom) {
  SimulatedStructure structure;
  structure.duration_s = 60.0;  // seven segments
  const ModalEstimate estimate = Identifier({}, structure.channels()).identify(structure.spectra());
  ASSERT_FALSE(estimate.modes.empty());
  EXPECT_GT(estimate.degrees_of_freedom, 1.0);
  EXPECT_LE(estimate.degrees_of_freedom, 6.0);
  for (const Mode& mode : estimate.modes) {
    EXPECT_TRUE(mode.frequency_std_hz.has_value()) << mode.frequency_hz;
    EXPECT_FALSE(mode.shape_std.empty()) << mode.frequency_hz;
  }
}

TEST(ModeScatter, IsEmptyForARecordOfOneBlock) {
  SimulatedStructure structure;
  structure.duration_s = 12.0;
  for (const Mode& mode : Identifier({}, structure.channels()).identify(structure.spectra()).modes)
    EXPECT_FALSE(mode.frequency_std_hz.has_value()) << mode.frequency_hz;
}

// Twelve records: the errors are as large as stated, within the accuracy of twelve records.
TEST(ModeScatter, StatesTheErrorsThatTheRecordsShow) {
  constexpr int kRecords = 12;
  double squares = 0.0, damping_squares = 0.0, shape_squares = 0.0;
  int n = 0, n_shape = 0;
  const Eigen::MatrixXd shapes = simulation::shear_chain_shapes(6);
  for (std::uint64_t seed = 1; seed <= kRecords; ++seed) {
    SimulatedStructure structure;
    structure.seed = seed;
    const ModalEstimate estimate = Identifier({}, structure.channels()).identify(structure.spectra());
    EXPECT_NEAR(estimate.degrees_of_freedom, 9.0, 1.0);
    for (std::size_t r = 0; r < 4; ++r) {
      for (const Mode& mode : estimate.modes) {
        if (std::abs(mode.frequency_hz - structure.frequency_hz(r)) > 0.15) continue;
        ASSERT_TRUE(mode.frequency_std_hz && mode.damping_std);
        squares += std::pow((mode.frequency_hz - structure.frequency_hz(r)) / *mode.frequency_std_hz, 2);
        damping_squares += std::pow((mode.damping_ratio - 0.01) / *mode.damping_std, 2);
        ++n;
        // A shape is 1 at its record's own largest component, which need not be the truth's.
        ASSERT_EQ(mode.shape_std[0], 0.0) << "the base is the input";
        const auto one = std::min_element(mode.shape_std.begin() + 1, mode.shape_std.end()) - mode.shape_std.begin();
        ASSERT_TRUE(one >= 1 && one <= 6) << one;  // a storey, not the base
        ASSERT_LT(mode.shape_std[static_cast<std::size_t>(one)], 1e-12);
        const Eigen::VectorXd truth =
            shapes.col(static_cast<Eigen::Index>(r)) / shapes(one - 1, static_cast<Eigen::Index>(r));
        for (Eigen::Index c = 0; c < 6; ++c) {
          const auto at = static_cast<std::size_t>(c) + 1;
          if (c == one - 1) continue;
          shape_squares += std::pow((mode.shape[at].real() - truth[c]) / mode.shape_std[at], 2);
          ++n_shape;
        }
      }
    }
  }
  ASSERT_GE(n, 4 * kRecords - 4);
  ASSERT_EQ(n_shape, 5 * n);
  // The mean square of Student's t with 9 degrees of freedom is 9 / 7.
  EXPECT_GT(squares / n, 0.6);
  EXPECT_LT(squares / n, 2.3);
  EXPECT_GT(damping_squares / n, 0.6);
  EXPECT_LT(damping_squares / n, 2.5);
  EXPECT_GT(shape_squares / n_shape, 0.4);
  EXPECT_LT(shape_squares / n_shape, 3.5);
}

TEST(Student, WidensForFewDegreesOfFreedom) {
  EXPECT_DOUBLE_EQ(student_95(9), 2.262);
  EXPECT_DOUBLE_EQ(student_95(1), 12.706);
  EXPECT_DOUBLE_EQ(student_95(30), 2.042);
  EXPECT_NEAR(student_95(60), 2.000, 2e-3);
  EXPECT_NEAR(student_95(1e6), 1.96, 1e-3);
  for (double k = 1.0; k < 40.0; k += 0.25) EXPECT_GT(student_95(k), student_95(k + 0.25)) << k;
  EXPECT_DOUBLE_EQ(student_95(0.3), 12.706);
}

TEST(DampingInterval, IsSymmetricInTheLogarithm) {
  Mode mode;
  mode.damping_ratio = 0.01;
  EXPECT_FALSE(damping_interval_95(mode, 9).has_value());
  mode.damping_std = 0.002;
  const auto interval = damping_interval_95(mode, 9);
  ASSERT_TRUE(interval.has_value());
  EXPECT_NEAR(interval->low * interval->high, 1e-4, 1e-12);
  EXPECT_NEAR(std::log(interval->high / 0.01), 2.262 * 0.2, 1e-12);
  EXPECT_FALSE(damping_interval_95(mode, 0.0).has_value());
  mode.damping_ratio = -0.001;
  EXPECT_FALSE(damping_interval_95(mode, 9).has_value());
  mode.damping_ratio = 1e-9;
  EXPECT_FALSE(damping_interval_95(mode, 9).has_value()) << "the factor is no number";
}

}  // namespace
}  // namespace core
