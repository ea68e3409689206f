// Identification with a measured input: which channels are inputs, the realisation, and its first-order changes.
#include "core/identification/given_inputs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>
#include <vector>

#include "core/identification/hankel_changes.h"
#include "core/identification/measured_inputs.h"
#include "core/identification/uncertainty.h"
#include "core/spectrum/welch_cpsd.h"
#include "tests/support/driven_system.h"
#include "tests/support/mixed_correlations.h"

namespace core {
namespace {

using Complex = std::complex<double>;
using test_support::DrivenSystem;

constexpr int kModes = 3, kOutputs = 4, kOrder = 2 * kModes;

EraConfig given_channel_0() {
  EraConfig config;
  config.block_rows = 12;
  config.max_order = kOrder;
  config.references = {1, 2, 3, 4};
  config.inputs = {0};
  return config;
}

const DiscretePole& nearest(const std::vector<DiscretePole>& poles, Complex lambda) {
  return *std::min_element(poles.begin(), poles.end(), [&](const auto& a, const auto& b) {
    return std::abs(a.lambda - lambda) < std::abs(b.lambda - lambda);
  });
}

TEST(GivenInputs, TheSystemIsFoundAndTheInputsOwnOscillationIsNot) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    const DrivenSystem driven(seed, kModes, kOutputs);
    const EraConfig config = given_channel_0();
    Realisation found;
    ASSERT_EQ(realise(driven.correlations(furthest_lag(config)), config, found), EraStatus::kOk);
    EXPECT_EQ(canonical_order(found, 0.1), kOrder) << found.singular_values.head(10).transpose();
    const std::vector<DiscretePole> poles = poles_of_order(found, kOrder);
    ASSERT_EQ(poles.size(), std::size_t{kModes});
    for (const auto& truth : driven.system.poles) {
      const DiscretePole& pole = nearest(poles, truth.lambda);
      EXPECT_NEAR(std::abs(pole.lambda - truth.lambda), 0.0, 1e-4) << seed;
      EXPECT_EQ(pole.shape[0], 0.0) << "the shape is relative to the input";
      for (std::size_t c = 1; c < truth.shape.size(); ++c) {
        EXPECT_NEAR(std::abs(pole.shape[c + 1] / pole.shape[1] - truth.shape[c] / truth.shape[0]), 0.0, 1e-2) << seed;
      }
    }
  }
}

TEST(GivenInputs, WithoutThemTheOscillationOfTheInputIsAPole) {
  const DrivenSystem driven(1, kModes, kOutputs);
  EraConfig config = given_channel_0();
  config.inputs.clear();
  config.max_order = kOrder + 2;
  Realisation found;
  ASSERT_EQ(realise(driven.correlations(furthest_lag(config)), config, found), EraStatus::kOk);
  const Complex own = std::polar(0.97, 0.9);
  EXPECT_NEAR(std::abs(nearest(poles_of_order(found, kOrder + 2), own).lambda - own), 0.0, 1e-3);
}

// As PoleChanges.AreTheDerivativeOfARefit, for the conditioned Hankel matrix.
void expect_changes_to_be_derivatives(int block_rows) {
  const DrivenSystem driven(5, kModes, kOutputs), other(6, kModes, kOutputs);
  EraConfig config = given_channel_0();
  config.block_rows = block_rows;
  const Correlations r = driven.correlations(60), s = other.correlations(60);
  Realisation at, moved;
  ASSERT_EQ(realise(r, config, at), EraStatus::kOk);
  const DeviationLags lags = hankel_change_lags(config, 0);
  const std::vector<int> references = hankel_change_references(config);
  const auto nr = static_cast<Eigen::Index>(references.size());
  BlockDeviations deviation{1, 0.0, Eigen::MatrixXd(kOutputs + 1, nr * lags.n)};
  for (int i = 0; i <= kOutputs; ++i) {
    for (Eigen::Index j = 0; j < nr; ++j) {
      const int reference = references[static_cast<std::size_t>(j)];
      for (int k = 0; k < lags.n; ++k) {
        deviation.value(i, nr * k + j) =
            s.divided(i, reference, lags.first + k) - r.divided(i, reference, lags.first + k);
      }
    }
  }
  std::vector<PoleOfOrder> poles;
  for (const DiscretePole& pole : poles_of_order(at, kOrder)) poles.push_back({kOrder, pole});
  const auto changes = pole_changes(at, config, deviation, poles);
  const double eps = 1e-10;  // with larger ones the weighted matrices change beyond first order
  ASSERT_EQ(realise(test_support::mixed_correlations(r, s, eps), config, moved), EraStatus::kOk);
  const std::vector<DiscretePole> later = poles_of_order(moved, kOrder);
  for (std::size_t p = 0; p < poles.size(); ++p) {
    const DiscretePole& before = poles[p].pole;
    const DiscretePole& after = nearest(later, before.lambda);
    const Complex slope = (after.lambda - before.lambda) / eps;
    ASSERT_EQ(changes[p].size(), 1U);
    EXPECT_NEAR(std::abs(changes[p][0].lambda - slope), 0.0, 1e-2 * std::abs(slope));
    EXPECT_EQ(changes[p][0].shape[0], 0.0);
    for (std::size_t c = 2; c < before.shape.size(); ++c) {
      const Complex ratio = before.shape[c] / before.shape[1];
      const Complex ratio_slope = (after.shape[c] / after.shape[1] - ratio) / eps;
      const Complex stated = (changes[p][0].shape[c] - ratio * changes[p][0].shape[1]) / before.shape[1];
      EXPECT_NEAR(std::abs(stated - ratio_slope), 0.0, 2e-2 * (1.0 + std::abs(ratio_slope))) << c;
    }
  }
}

TEST(GivenInputs, ChangesAreTheDerivativeOfARefit) { expect_changes_to_be_derivatives(12); }

// The window of the inputs is then as long before the present as the past.
TEST(GivenInputs, ChangesAreTheDerivativeOfARefitWithAShortMemory) {
  EraConfig config = given_channel_0();
  config.block_rows = 4;
  EXPECT_EQ(input_margin(config), 4);
  expect_changes_to_be_derivatives(4);
}

// Base, two floors and a region at rest, of white noise. The base moves until `until` of the record; the region follows
// the floors' motion against one another by `follows`.
CpsdSums spectra_of(double until, double follows) {
  WelchConfig config;
  config.n_channels = 4;
  config.segment = 128;
  config.rate_hz = 25.0;
  WelchCpsd welch(config);
  std::mt19937_64 random(3);
  std::normal_distribution<double> gaussian;
  constexpr int kSamples = 3000;
  const std::vector<std::uint8_t> seen(4, 1);
  for (int k = 0; k < kSamples; ++k) {
    const double base = k < until * kSamples ? gaussian(random) : 0.0, bending = gaussian(random);
    const std::vector<double> value{base + 0.01 * gaussian(random), base + bending, base - bending,
                                    follows * bending + gaussian(random)};
    welch.push(value, seen);
  }
  welch.flush();
  return welch.sums();
}

std::vector<ChannelInfo> base_floors_and_rest() {
  std::vector<ChannelInfo> channels(4);
  channels[0].is_base = true;
  channels[3].is_witness = true;
  return channels;
}

TEST(MeasuredInputs, AreABaseAndARegionAtRest) {
  EXPECT_EQ(measured_inputs(spectra_of(1.0, 0.0), base_floors_and_rest()), (std::vector{0, 3}));
}

TEST(MeasuredInputs, ARegionThatMovesWithTheStructureIsNone) {
  EXPECT_EQ(measured_inputs(spectra_of(1.0, 3.0), base_floors_and_rest()), (std::vector{0}));
}

TEST(MeasuredInputs, ABaseThatMovesForAPartOfTheRecordIsNone) {
  EXPECT_TRUE(measured_inputs(spectra_of(0.3, 0.0), base_floors_and_rest()).empty());
}

// The last channel is the rotation of a region at rest.
TEST(MeasuredInputs, TheCamerasRotationIsOneAlsoWithoutABaseUnlessTheRegionMovesWithTheStructure) {
  std::vector<ChannelInfo> channels = base_floors_and_rest();
  channels[3].direction_u = 0.0;
  EXPECT_EQ(measured_inputs(spectra_of(1.0, 3.0), channels), (std::vector{0, 3})) << "it may bend the view";
  channels[0].is_base = false;
  EXPECT_EQ(measured_inputs(spectra_of(1.0, 3.0), channels), (std::vector{3}));
  channels[1].is_witness = true;  // explains all that channel 2 does against channel 0
  EXPECT_TRUE(measured_inputs(spectra_of(1.0, 3.0), channels).empty());
}

TEST(MeasuredInputs, WithoutABaseThereAreNone) {
  std::vector<ChannelInfo> channels = base_floors_and_rest();
  channels[0].is_base = false;
  EXPECT_TRUE(measured_inputs(spectra_of(1.0, 0.0), channels).empty());
}

}  // namespace
}  // namespace core
