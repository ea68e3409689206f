// IdentifierConfig::as_published: the identification of Yoon et al. 2017.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/identification/era.h"
#include "core/identification/identifier.h"
#include "core/identification/real_shape.h"
#include "core/identification/stabilisation.h"
#include "core/identification/verdict.h"
#include "tests/support/simulated_structure.h"

namespace core {
namespace {

using test_support::SimulatedStructure;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

IdentifierConfig published() {
  IdentifierConfig config;
  config.as_published = true;
  return config;
}

std::vector<double> frequencies(const ModalEstimate& estimate) {
  std::vector<double> all;
  for (const auto* list : {&estimate.modes, &estimate.rejected}) {
    for (const Mode& mode : *list) all.push_back(mode.frequency_hz);
  }
  std::sort(all.begin(), all.end());
  return all;
}

// The same poles by core/identification/era.h, plain, on correlations from lag 1 on, without differencing.
TEST(PublishedIdentification, IsPlainEraOfOneOrderOnUndifferencedCorrelations) {
  SimulatedStructure structure;
  structure.duration_s = 120.0;
  const CpsdSums sums = structure.spectra();
  IdentifierConfig config = published();
  config.block_rows = 20, config.max_order = 24, config.references = {1, 4, 6}, config.n_differences = 1;
  const ModalEstimate estimate = Identifier(config, structure.channels()).identify(sums);
  ASSERT_EQ(estimate.status, "ok");
  EXPECT_EQ(estimate.model_order, 24);
  for (const StabilisationPole& pole : estimate.poles) EXPECT_EQ(pole.order, 24);

  Correlations correlations;
  ASSERT_EQ(compute_correlations(sums, 41, 0, correlations), CorrelationStatus::kOk);
  EraConfig era;
  era.block_rows = 20, era.first_lag = 1, era.max_order = 24, era.references = {1, 4, 6},
  era.canonical_variates = false;
  Realisation realisation;
  ASSERT_EQ(realise(correlations, era, realisation), EraStatus::kOk);
  std::vector<double> plain;
  for (const DiscretePole& pole : poles_of_order(realisation, 24))
    plain.push_back(frequency_hz(std::log(pole.lambda) * sums.rate_hz));
  std::sort(plain.begin(), plain.end());
  const std::vector<double> found = frequencies(estimate);
  ASSERT_EQ(found.size(), plain.size());
  for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_NEAR(found[i], plain[i], 1e-9 * plain[i]);
}

TEST(PublishedIdentification, FindsTheThreeModesOfThePaper) {
  SimulatedStructure structure;
  const ModalEstimate estimate = Identifier(published(), structure.channels()).identify(structure.spectra());
  for (std::size_t r = 0; r < 3; ++r) {
    const auto is_it = [&](const Mode& mode) {
      return std::abs(mode.frequency_hz / structure.frequency_hz(r) - 1.0) < 0.01;
    };
    const auto mode = std::find_if(estimate.modes.begin(), estimate.modes.end(), is_it);
    ASSERT_NE(mode, estimate.modes.end()) << "mode " << r + 1;
    std::vector<std::complex<double>> truth{0.0};
    for (const std::complex<double> x : structure.modes[r].displacement) truth.push_back(x);
    EXPECT_GT(real_mac(mode->shape, truth), 0.99) << "mode " << r + 1;
  }
}

PoleCluster pole(double frequency_hz, double base, double damping_ratio = 0.01) {
  PoleCluster out;
  out.frequency_hz = out.apparent_hz = frequency_hz;
  out.damping_ratio = damping_ratio;
  // Out of phase, and in one order of many: the rules of method hovermodal refuse both.
  out.representative.shape = {base, {0.0, 0.7}, 1.0};
  out.representative.mpc = 0.1;
  out.first_i_order = 9, out.presence = 0.1;
  return out;
}

Mode judged(const PoleCluster& line) {
  std::vector<ChannelInfo> channels(3);
  channels[0].is_base = true;
  return judge_as_published(line, channels, VerdictRules{});
}

TEST(PublishedVerdict, AsksForAVibrationInWhichTheBaseTakesLittlePartAndNoMore) {
  EXPECT_EQ(judged(pole(5.0, 0.1)).verdict, Verdict::kStructural);
  const Mode shaken = judged(pole(5.0, 0.9));
  EXPECT_EQ(shaken.verdict, Verdict::kInputPeak);
  EXPECT_THAT(shaken.reason, HasSubstr("the base moves 0.90 of the largest channel"));
  for (const double damping_ratio : {-0.001, 0.0, 0.16}) {
    EXPECT_EQ(judged(pole(5.0, 0.1, damping_ratio)).verdict, Verdict::kNumerical) << damping_ratio;
  }
}

TEST(PublishedVerdict, NumbersModesByFrequency) {
  std::vector<Mode> modes{judged(pole(8.1, 0.0)), judged(pole(0.1, 0.95)), judged(pole(1.6, 0.0)),
                          judged(pole(5.0, 0.0))};
  number_by_frequency(modes);
  EXPECT_THAT(modes[0].reason, AllOf(HasSubstr("number 3 by frequency"), HasSubstr("no further test")));
  EXPECT_THAT(modes[1].reason, Not(HasSubstr("by frequency")));
  EXPECT_THAT(modes[2].reason, HasSubstr("number 1 by frequency"));
  EXPECT_THAT(modes[3].reason, HasSubstr("number 2 by frequency"));
}

}  // namespace
}  // namespace core
