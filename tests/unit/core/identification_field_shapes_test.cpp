#include "core/identification/field_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <vector>

#include "core/identification/identifier.h"
#include "tests/support/simulated_structure.h"

namespace core {
namespace {

using test_support::SimulatedStructure;

template <class T>
std::vector<T> picked(const std::vector<T>& all, const std::vector<std::size_t>& which) {
  std::vector<T> out;
  for (const std::size_t i : which) out.push_back(all[i]);
  return out;
}

using Sums = std::vector<std::complex<double>>;

// Pairs of the channels `which`, in any order and with repetitions.
Sums in_order(const Sums& from, int n_channels, const std::vector<std::size_t>& which) {
  const auto n_pairs = static_cast<std::size_t>(n_channels * (n_channels + 1) / 2);
  Sums out;
  for (std::size_t first = 0; first + n_pairs <= from.size(); first += n_pairs) {
    for (std::size_t a = 0; a < which.size(); ++a) {
      for (std::size_t b = a; b < which.size(); ++b) {
        const auto i = static_cast<int>(which[a]), j = static_cast<int>(which[b]);
        const auto value =
            from[first + static_cast<std::size_t>(CpsdSums::pair_index(std::min(i, j), std::max(i, j), n_channels))];
        out.push_back(i > j ? std::conj(value) : value);
      }
    }
  }
  return out;
}

CpsdSums in_order(const CpsdSums& sums, const std::vector<std::size_t>& which) {
  CpsdSums out = sums;
  out.n_channels = static_cast<int>(which.size());
  out.n_outlying.clear();
  out.data_sum = in_order(sums.data_sum, sums.n_channels, which);
  out.mask_sum = in_order(sums.mask_sum, sums.n_channels, which);
  for (CpsdBlock& block : out.blocks) {
    block.data_sum = in_order(block.data_sum, sums.n_channels, which);
    block.mask_sum = in_order(block.mask_sum, sums.n_channels, which);
  }
  return out;
}

// Modes identified from base, floors 2, 4, 5 and 6; floors 1 and 3 as further channels.
struct Parted {
  CpsdSums sums;
  std::vector<ChannelInfo> channels;
  std::vector<std::size_t> core{0, 2, 4, 5, 6}, further{1, 3};
  FieldShapes field;
  ModalEstimate estimate;

  explicit Parted(bool has_base, double delay_step_s = 0.0) {
    SimulatedStructure structure;
    structure.delay_step_s = delay_step_s;
    sums = structure.spectra();
    channels = structure.channels();
    channels[0].is_base = has_base;
    estimate = Identifier({}, picked(channels, core)).identify(in_order(sums, core), field);
  }
  [[nodiscard]] std::vector<FieldShapes::Components> components() const {
    std::vector<std::size_t> all;
    for (const int r : field.references()) all.push_back(core[static_cast<std::size_t>(r)]);
    all.insert(all.end(), further.begin(), further.end());
    std::vector<double> delay_s;
    for (const std::size_t c : further) delay_s.push_back(channels[c].row_delay_s);
    return field.of(in_order(sums, all), picked(channels, further), delay_s);
  }
};

class FieldShapesOf : public testing::TestWithParam<bool> {};

TEST_P(FieldShapesOf, FurtherChannelsLieWithinTheirSigmaOfTheTruth) {
  const Parted parted(GetParam(), 0.003);
  const Eigen::MatrixXd truth = simulation::shear_chain_shapes(6);
  const auto found = parted.components();
  ASSERT_EQ(found.size(), parted.estimate.modes.size() + parted.estimate.rejected.size());
  ASSERT_GE(parted.estimate.modes.size(), 4U);
  SimulatedStructure structure;
  for (std::size_t m = 0; m < 4; ++m) {
    const Mode& mode = parted.estimate.modes[m];
    ASSERT_NEAR(mode.frequency_hz, structure.frequency_hz(m), 0.1);
    ASSERT_TRUE(found[m].is_known);
    ASSERT_EQ(found[m].shape.size(), 2U);
    ASSERT_EQ(found[m].std.size(), 2U);
    std::size_t largest = 0;
    for (std::size_t i = 0; i < mode.shape.size(); ++i) {
      if (std::norm(mode.shape[i]) > std::norm(mode.shape[largest])) largest = i;
    }
    const auto column = static_cast<Eigen::Index>(m);
    const double one = truth(static_cast<Eigen::Index>(parted.core[largest]) - 1, column);
    for (std::size_t i = 0; i < 2; ++i) {
      const double expected = truth(static_cast<Eigen::Index>(parted.further[i]) - 1, column) / one;
      EXPECT_GT(found[m].std[i], 0.0);
      EXPECT_LT(found[m].std[i], 0.1);
      EXPECT_NEAR(found[m].shape[i].real(), expected, 4.0 * found[m].std[i]) << "mode " << m + 1;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(WithAndWithoutAnInput, FieldShapesOf, testing::Bool());

// A channel of the core given once more as a further one has the component that it has.
TEST(FieldShapes, AChannelOfTheCoreGetsItsOwnComponent) {
  for (const bool has_base : {false, true}) {
    Parted parted(has_base);
    parted.further = {4};
    const auto found = parted.components();
    for (std::size_t m = 0; m < parted.estimate.modes.size(); ++m) {
      const Mode& mode = parted.estimate.modes[m];
      EXPECT_NEAR(std::abs(found[m].shape[0] - mode.shape[2]), 0.0, 1e-6) << mode.frequency_hz;
      EXPECT_NEAR(found[m].std[0], mode.shape_std[2], 1e-6 + 1e-3 * mode.shape_std[2]) << mode.frequency_hz;
    }
  }
}

TEST(FieldShapes, ReferencesAreNumberedAmongTheChannelsGiven) {
  SimulatedStructure structure;
  CpsdSums sums = structure.spectra();
  FieldShapes field;
  const ModalEstimate estimate = Identifier({}, structure.channels()).identify(sums, field);
  ASSERT_FALSE(estimate.modes.empty());
  EXPECT_EQ(field.references().size(), 7U) << "six floors and the base";
  field.renumber({10, 11, 12, 13, 14, 15, 16});
  EXPECT_EQ(*std::min_element(field.references().begin(), field.references().end()), 10);
}

TEST(FieldShapes, OfAnEstimateWithoutAModelThereAreNone) {
  const SimulatedStructure structure;
  FieldShapes field;
  WelchConfig config;
  config.n_channels = structure.n_channels();
  config.rate_hz = structure.rate_hz;
  const WelchCpsd nothing_yet(config);
  const ModalEstimate estimate = Identifier({}, structure.channels()).identify(nothing_yet.sums(), field);
  EXPECT_NE(estimate.status, "ok");
  EXPECT_TRUE(field.of(nothing_yet.sums(), {}, {}).empty());
}

}  // namespace
}  // namespace core
