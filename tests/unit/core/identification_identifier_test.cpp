#include "core/identification/identifier.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <stdexcept>

#include "core/identification/mac.h"
#include "tests/support/simulated_structure.h"

namespace core {
namespace {

using test_support::SimulatedStructure;

// The mode nearest to a true frequency, within a tenth of the gap to its neighbours; null when there is none.
const Mode* find(const ModalEstimate& estimate, double frequency_hz) {
  const Mode* nearest = nullptr;
  for (const Mode& mode : estimate.modes) {
    if (std::abs(mode.frequency_hz - frequency_hz) > 0.15) continue;
    if (nearest == nullptr ||
        std::abs(mode.frequency_hz - frequency_hz) < std::abs(nearest->frequency_hz - frequency_hz))
      nearest = &mode;
  }
  return nearest;
}

std::size_t nearest_true_mode(const SimulatedStructure& structure, double frequency_hz) {
  std::size_t best = 0;
  for (std::size_t r = 1; r < structure.modes.size(); ++r) {
    if (std::abs(structure.frequency_hz(r) - frequency_hz) < std::abs(structure.frequency_hz(best) - frequency_hz)) {
      best = r;
    }
  }
  return best;
}

double mac_with_truth(const Mode& mode, Eigen::Index true_mode) {
  const Eigen::MatrixXd shapes = simulation::shear_chain_shapes(6);
  const std::vector<std::complex<double>> truth(shapes.col(true_mode).begin(), shapes.col(true_mode).end());
  return mac(truth, std::span(mode.shape).subspan(1));  // channel 0 is the base
}

TEST(Identifier, ListsThePolesOfEveryOrderWithTheLineTheyJoined) {
  SimulatedStructure structure;
  const ModalEstimate estimate = Identifier({}, structure.channels()).identify(structure.spectra());
  ASSERT_FALSE(estimate.modes.empty());
  ASSERT_FALSE(estimate.poles.empty());
  EXPECT_LE(estimate.poles.size(), kMaxStabilisationPoles);
  const std::vector<Mode>& modes = estimate.modes;
  std::vector<int> n_orders(modes.size() + estimate.rejected.size());
  int last_order = 0;
  for (const StabilisationPole& pole : estimate.poles) {
    EXPECT_GE(pole.order, last_order);
    last_order = pole.order;
    EXPECT_GE(pole.order, estimate.model_order);
    if (pole.i_line < 0) continue;
    const auto i = static_cast<std::size_t>(pole.i_line);
    ASSERT_LT(i, n_orders.size());
    ++n_orders[i];
    const Mode& mode = i < modes.size() ? modes[i] : estimate.rejected[i - modes.size()];
    EXPECT_NEAR(pole.apparent_hz / mode.apparent_hz, 1.0, 0.05);
  }
  for (std::size_t i = 0; i < modes.size(); ++i) EXPECT_GE(n_orders[i], 13) << modes[i].frequency_hz;  // of 15
}

TEST(Identifier, FindsTheModesOfASixStoreyFrameNearTheTheoreticalScatter) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    SimulatedStructure structure;
    structure.seed = seed;
    const ModalEstimate estimate = Identifier({}, structure.channels()).identify(structure.spectra());
    ASSERT_EQ(estimate.status, "ok");
    EXPECT_NEAR(estimate.duration_s, 300.0, 1e-9);
    for (const Mode& mode : estimate.modes) {  // no false structural mode
      const std::size_t r = nearest_true_mode(structure, mode.frequency_hz);
      // The scatter of a perfect record; weak modes scatter more and state it.
      const double sigma_hz = std::max(structure.frequency_scatter_hz(r), mode.frequency_std_hz.value_or(0.0));
      EXPECT_LT(std::abs(mode.frequency_hz - structure.frequency_hz(r)), 3.0 * sigma_hz) << mode.frequency_hz;
      EXPECT_LT(sigma_hz, 0.01 * mode.frequency_hz);
    }
    for (std::size_t r = 0; r < 4; ++r) {  // the upper two are weak: whether they are found depends on tuning
      const Mode* mode = find(estimate, structure.frequency_hz(r));
      ASSERT_NE(mode, nullptr) << "mode " << r + 1;
      EXPECT_LT(std::abs(mode->damping_ratio - 0.01), 3.0 * structure.damping_scatter(r)) << "mode " << r + 1;
      EXPECT_GT(mac_with_truth(*mode, static_cast<Eigen::Index>(r)), 0.99) << "mode " << r + 1;
      EXPECT_EQ(mode->shape.size(), 7U);
    }
  }
}

// The camera of the paper: 25 frames a second. Modes 5 and 6 lie above the Nyquist frequency; row delays resolve them.
TEST(Identifier, UnfoldsModesAboveHalfTheRateByTheirRowDelays) {
  int n_found = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    SimulatedStructure structure;
    structure.seed = seed;
    structure.rate_hz = 25.0;
    structure.segment = 512;
    structure.delay_step_s = 0.9 * 0.15 / 25.0;
    IdentifierConfig config;
    config.max_frequency_hz = 20.0;
    const ModalEstimate estimate = Identifier(config, structure.channels()).identify(structure.spectra());
    ASSERT_EQ(estimate.status, "ok");
    for (const Mode& mode : estimate.modes) {
      const std::size_t r = nearest_true_mode(structure, mode.frequency_hz);
      // Weak modes scatter more than those of a perfect record, and state it.
      const double sigma_hz = std::max(structure.frequency_scatter_hz(r), mode.frequency_std_hz.value_or(0.0));
      EXPECT_LT(std::abs(mode.frequency_hz - structure.frequency_hz(r)), 3.0 * sigma_hz) << mode.frequency_hz;
    }
    const Mode* fifth = find(estimate, structure.frequency_hz(4));
    if (fifth == nullptr) continue;
    ++n_found;
    EXPECT_EQ(fifth->fold_n, -1);
    EXPECT_NEAR(fifth->apparent_hz, 25.0 - structure.frequency_hz(4), 0.05);
    EXPECT_GT(mac_with_truth(*fifth, 4), 0.95);
  }
  EXPECT_GE(n_found, 2);
}

TEST(Identifier, ShapesHaveALargestComponentOfOneAndModesRiseInFrequency) {
  SimulatedStructure structure;
  structure.duration_s = 120.0;
  const ModalEstimate estimate = Identifier({}, structure.channels()).identify(structure.spectra());
  ASSERT_GT(estimate.modes.size(), 2U);
  double last_hz = 0.0;
  for (const Mode& mode : estimate.modes) {
    double largest = 0.0;
    bool has_one = false;
    for (const auto& z : mode.shape) {
      largest = std::max(largest, std::abs(z));
      has_one = has_one || z == std::complex<double>(1.0, 0.0);
    }
    EXPECT_TRUE(has_one);
    EXPECT_LE(largest, 1.0 + 1e-12);
    EXPECT_GE(mode.frequency_hz, last_hz);
    last_hz = mode.frequency_hz;
    EXPECT_EQ(mode.verdict, Verdict::kStructural);
  }
  for (const Mode& mode : estimate.rejected) EXPECT_NE(mode.verdict, Verdict::kStructural);
}

TEST(Identifier, GivesTheSameBitsAgain) {
  SimulatedStructure structure;
  structure.duration_s = 60.0;
  const CpsdSums sums = structure.spectra();
  const ModalEstimate a = Identifier({}, structure.channels()).identify(sums);
  const ModalEstimate b = Identifier({}, structure.channels()).identify(sums);
  ASSERT_EQ(a.modes.size(), b.modes.size());
  ASSERT_GT(a.modes.size(), 0U);
  for (std::size_t i = 0; i < a.modes.size(); ++i) {
    EXPECT_EQ(a.modes[i].frequency_hz, b.modes[i].frequency_hz);
    EXPECT_EQ(a.modes[i].damping_ratio, b.modes[i].damping_ratio);
    EXPECT_EQ(a.modes[i].shape, b.modes[i].shape);
  }
}

TEST(Identifier, TakesTheReferencesItIsGiven) {
  SimulatedStructure structure;
  structure.duration_s = 120.0;
  const CpsdSums sums = structure.spectra();
  IdentifierConfig config;
  config.references = {2, 5};
  const ModalEstimate estimate = Identifier(config, structure.channels()).identify(sums);
  ASSERT_EQ(estimate.status, "ok");
  EXPECT_NE(find(estimate, structure.frequency_hz(1)), nullptr);
}

TEST(Identifier, RefusesReferencesThatAreNoChannel) {
  const std::vector<ChannelInfo> two(2);
  IdentifierConfig config;
  for (const int reference : {-1, 2}) {
    config.references = {0, reference};
    EXPECT_THROW(Identifier(config, two), std::invalid_argument) << reference;
  }
  EXPECT_THROW(Identifier({}, {}), std::invalid_argument);
}

// Narrow bands of the input, in decreasing order, fall below the noise one by one: there is no gap.
TEST(Identifier, SaysWhenTheOrderIsUnclear) {
  WelchConfig welch;
  welch.n_channels = 4;
  welch.segment = 1024;
  welch.rate_hz = 60.0;
  WelchCpsd cpsd(welch);
  std::mt19937_64 random(3);
  std::normal_distribution<double> gaussian;
  const std::vector<std::uint8_t> seen(4, 1);
  std::vector<std::complex<double>> amplitude(60);  // random walks with a memory of 5000 samples
  for (int t = 0; t < 6000; ++t) {
    std::vector<double> value;
    for (auto& a : amplitude) a += 0.02 * std::complex<double>{gaussian(random), gaussian(random)} - 2e-4 * a;
    for (int c = 0; c < 4; ++c) {
      value.push_back(0.3 * gaussian(random));
      for (int k = 0; k < 60; ++k)
        value.back() +=
            (std::polar(std::pow(0.93, k), 0.045 * (k + 1) * t + 0.7 * k * c) * amplitude[static_cast<std::size_t>(k)])
                .real();
    }
    (void)cpsd.push(value, seen);
  }
  cpsd.flush();
  IdentifierConfig config;
  config.n_differences = 0;
  const ModalEstimate estimate = Identifier(config, std::vector<ChannelInfo>(4)).identify(cpsd.sums());
  EXPECT_NE(estimate.status.find("order unclear"), std::string::npos) << estimate.status;
  EXPECT_EQ(estimate.model_order, 0);
}

TEST(Identifier, AnOrdinaryRecordHasAClearOrder) {
  SimulatedStructure structure;
  const ModalEstimate estimate = Identifier({}, structure.channels()).identify(structure.spectra());
  EXPECT_EQ(estimate.status, "ok");
  EXPECT_GE(estimate.model_order, 12);
  EXPECT_LE(estimate.model_order, 16);
}

}  // namespace
}  // namespace core
