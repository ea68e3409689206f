#include "core/identification/participation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "core/identification/identifier.h"
#include "core/identification/mac.h"
#include "core/identification/spectral_peaks.h"
#include "tests/support/simulated_structure.h"

namespace core {
namespace {

using test_support::SimulatedStructure;
constexpr std::size_t kDamaged = 3;  // floor3

// A minute of the six-storey frame; seen(c, share of the record).
CpsdSums spectra(const SimulatedStructure& structure, double duration_s,
                 const std::function<bool(std::size_t c, double share)>& is_seen) {
  const simulation::StructureResponse response(structure.scene.structure, structure.scene.excitation, structure.seed,
                                               duration_s + 1.0);
  WelchConfig config;
  config.n_channels = structure.n_channels(), config.segment = 512, config.rate_hz = structure.rate_hz;
  WelchCpsd welch(config);
  std::mt19937_64 random(structure.seed);
  std::normal_distribution<double> gaussian(0.0, structure.noise_mm);
  const auto channels = static_cast<std::size_t>(config.n_channels);
  std::vector<double> value(channels);
  std::vector<std::uint8_t> seen(channels);
  const auto n = static_cast<int>(duration_s * structure.rate_hz);
  for (int k = 0; k < n; ++k) {
    for (std::size_t c = 0; c < channels; ++c) {
      value[c] = response.displacement_mm(static_cast<int>(c), k / structure.rate_hz) + gaussian(random);
      seen[c] = is_seen(c, static_cast<double>(k) / n) ? 1 : 0;
    }
    welch.push(value, seen);
  }
  welch.flush();
  return welch.sums();
}

TEST(Participation, AWholeRecordKeepsAllChannels) {
  SimulatedStructure structure;
  const auto part =
      participation(spectra(structure, 60.0, [](std::size_t, double) { return true; }), structure.channels());
  EXPECT_TRUE(part.all());
  for (const ChannelRecord& record : part.records) EXPECT_NEAR(record.seen, 1.0, 1e-12);
}

TEST(Participation, ACoveredChannelTakesNoPartAndSaysWhy) {
  SimulatedStructure structure;
  for (const double from : {0.01, 0.2, 0.6, 0.8}) {
    const auto part = participation(
        spectra(structure, 60.0, [&](std::size_t c, double share) { return c != kDamaged || share < from; }),
        structure.channels());
    EXPECT_EQ(part.kept.size(), 6U) << from;
    EXPECT_FALSE(part.records[kDamaged].takes_part);
    EXPECT_NE(part.records[kDamaged].reason.find("of the record"), std::string::npos) << part.records[kDamaged].reason;
  }
}

TEST(Participation, AChannelWithoutASampleIsNamed) {
  SimulatedStructure structure;
  const auto part = participation(spectra(structure, 60.0, [](std::size_t c, double) { return c != kDamaged; }),
                                  structure.channels());
  EXPECT_EQ(part.records[kDamaged].reason, "it has no sample");
}

TEST(Participation, RandomLossesAndAShortCoverDoNotExclude) {
  SimulatedStructure structure;
  std::mt19937 random(1);
  std::bernoulli_distribution lost(0.4);
  EXPECT_TRUE(
      participation(spectra(structure, 60.0, [&](std::size_t c, double) { return c != kDamaged || !lost(random); }),
                    structure.channels())
          .all());
  EXPECT_TRUE(
      participation(spectra(structure, 60.0, [](std::size_t c, double share) { return c != kDamaged || share < 0.96; }),
                    structure.channels())
          .all());
}

TEST(Participation, WithoutACoveredFloorTheModesAreThoseOfTheOthers) {
  SimulatedStructure structure;
  const Identifier identifier({}, structure.channels());
  const ModalEstimate whole = identifier.identify(spectra(structure, 120.0, [](std::size_t, double) { return true; }));
  ASSERT_GE(whole.modes.size(), 4U);
  for (const double from : {0.01, 0.2, 0.6}) {
    const ModalEstimate estimate = identifier.identify(
        spectra(structure, 120.0, [&](std::size_t c, double share) { return c != kDamaged || share < from; }));
    ASSERT_EQ(estimate.channels.size(), 7U);
    EXPECT_FALSE(estimate.channels[kDamaged].takes_part);
    for (const Mode& mode : estimate.modes) {
      ASSERT_EQ(mode.shape.size(), 7U);
      EXPECT_EQ(mode.shape[kDamaged], 0.0);
      double nearest = 1.0;
      for (const auto& truth : structure.modes)
        nearest = std::min(nearest, std::abs(mode.frequency_hz / truth.frequency_hz - 1.0));
      EXPECT_LT(nearest, 0.02) << mode.frequency_hz << " is no mode of the structure";
    }
    EXPECT_GE(estimate.modes.size(), whole.modes.size() - 1);
  }
}

TEST(Participation, ALonePoleOfAPartlyMaskedChannelIsFound) {
  std::vector<ChannelRecord> records(3);
  EXPECT_EQ(lone_masked_channel({0.1, 1.0, 0.1}, records), -1);
  records[1].seen = 0.8;
  EXPECT_EQ(lone_masked_channel({0.1, 1.0, 0.1}, records), 1);
  EXPECT_EQ(lone_masked_channel({0.8, 1.0, 0.1}, records), -1);
}

TEST(SpectralPeaks, AreThereForAShortRecordWithTheirShares) {
  SimulatedStructure structure;
  const CpsdSums sums = spectra(structure, 8.0, [](std::size_t, double) { return true; });
  const auto peaks = spectral_peaks(sums, structure.channels());
  ASSERT_FALSE(peaks.empty());
  double nearest_hz = 1e9;
  for (const SpectralPeak& peak : peaks) {
    EXPECT_NEAR(peak.resolution_hz, structure.rate_hz / 480.0, 1e-9);
    ASSERT_EQ(peak.share.size(), 7U);
    EXPECT_NEAR(*std::max_element(peak.share.begin(), peak.share.end()), 1.0, 1e-12);
    nearest_hz = std::min(nearest_hz, std::abs(peak.frequency_hz - structure.frequency_hz(0)));
  }
  EXPECT_LT(nearest_hz, structure.rate_hz / 480.0);
}

}  // namespace
}  // namespace core
