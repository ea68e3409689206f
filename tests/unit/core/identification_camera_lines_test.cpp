#include "core/identification/camera_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/identification/identifier.h"
#include "core/spectrum/welch_cpsd.h"

namespace core {
namespace {

constexpr double kRate_hz = 25.0, kTwoPi = 2.0 * std::numbers::pi;
constexpr std::size_t kOutputs = 7;
constexpr std::array<double, kOutputs> kShape{0.2, 0.4, 0.6, 0.75, 0.9, 1.0, 0.0};

// A structure in noise, seen from a camera that hovers and vibrates.
struct Flight {
  double seconds = 120.0, mode_hz = 5.0, readout_s = 0.03;
  double rotor_hz = 0.0, rotor_mm = 0.0, wander_hz = 0.3;
  bool has_region = true, is_declared = true;  // ... whose delays are known
  bool evenly = false;                         // rows at equal distances
};

double delay_s(const Flight& flight, std::size_t channel) {
  const double row = static_cast<double>(channel) / static_cast<double>(kOutputs);
  return flight.readout_s * (flight.evenly ? row : 0.6 * row + 0.4 * row * row);
}

std::vector<ChannelInfo> channels(const Flight& flight) {
  std::vector<ChannelInfo> out(kOutputs + (flight.has_region ? 1 : 0));
  for (std::size_t c = 0; c < out.size(); ++c) {
    out[c].name = "c" + std::to_string(c);
    out[c].row_delay_s = flight.is_declared ? delay_s(flight, c) : 0.0;
    out[c].is_witness = c == kOutputs;
  }
  return out;
}

CpsdSums sums_of(const Flight& flight, unsigned seed) {
  const std::size_t n = channels(flight).size();
  WelchConfig config;
  config.n_channels = static_cast<int>(n);
  config.rate_hz = kRate_hz;
  WelchCpsd welch(config);
  std::mt19937 random(seed);
  std::normal_distribution<double> gaussian;
  const std::complex<double> lambda = std::exp(std::complex<double>(-0.01, 1.0) * kTwoPi * flight.mode_hz / kRate_hz);
  std::complex<double> state;
  double hover = 0.0, speed = 0.0, phase = 0.4, off_hz = 0.0;
  std::vector<double> value(n);
  for (int k = 0; k < static_cast<int>(flight.seconds * kRate_hz); ++k) {
    state = lambda * state + 0.1 * gaussian(random);
    speed = 0.9 * speed + 0.1 * gaussian(random), hover = 0.95 * hover + speed;
    off_hz = 0.98 * off_hz + flight.wander_hz * std::sqrt(1.0 - 0.98 * 0.98) * gaussian(random);
    phase += kTwoPi * (flight.rotor_hz + off_hz) / kRate_hz;
    for (std::size_t c = 0; c < n; ++c) {
      const double turn = kTwoPi * (flight.rotor_hz + off_hz) * delay_s(flight, c);
      value[c] = hover + flight.rotor_mm * std::cos(phase + turn) + 0.02 * gaussian(random);
      if (c < kOutputs) value[c] += kShape[c] * state.real();
    }
    welch.push(value, std::vector<std::uint8_t>(n, 1));
  }
  welch.flush();
  return welch.sums();
}

FoldingConfig folding_of(const Flight& flight) {
  FoldingConfig folding{kRate_hz, 0.5 * kRate_hz, {}};
  for (std::size_t c = 0; c < kOutputs; ++c) folding.delay_s.push_back(channels(flight)[c].row_delay_s);
  folding.n_integrations.assign(kOutputs, 0);
  return folding;
}

std::vector<CameraLine> by_rows(const Flight& flight, unsigned seed) {
  return lines_by_row_phases(sums_of(flight, seed), channels(flight), folding_of(flight), {flight.mode_hz});
}

std::vector<CameraLine> of_region(const Flight& flight, unsigned seed) {
  return lines_of_static_regions(sums_of(flight, seed), channels(flight), folding_of(flight));
}

std::vector<Mode> listed(const Flight& flight, unsigned seed) {
  ModalEstimate estimate;
  list_camera_lines(sums_of(flight, seed), channels(flight), folding_of(flight), estimate);
  return estimate.rejected;
}

TEST(CameraLines, ARotorIsFoundInAStaticRegionWithItsTrueFrequency) {
  const Flight flight{.rotor_hz = 134.0, .rotor_mm = 0.2};  // seen at 9 Hz
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto lines = of_region(flight, seed);
    ASSERT_EQ(lines.size(), 1u) << seed;
    EXPECT_NEAR(lines[0].apparent_hz, 9.0, 0.3);
    EXPECT_GT(lines[0].height, 5.0);
    ASSERT_FALSE(lines[0].true_hz.empty());
    EXPECT_NEAR(std::abs(lines[0].true_hz.front()), 134.0, 0.3);
    ASSERT_EQ(lines[0].motion.size(), kOutputs);
    for (const auto& motion : lines[0].motion) EXPECT_NEAR(std::abs(motion), 1.0, 0.1);
  }
}

TEST(CameraLines, RowsAtEqualDistancesNameAllFrequenciesThatTheyDoNotDistinguish) {
  const auto lines = of_region({.rotor_hz = 134.0, .rotor_mm = 0.2, .evenly = true}, 1);  // repeat at 7 / 30 ms
  ASSERT_EQ(lines.size(), 1u);
  ASSERT_EQ(lines[0].true_hz.size(), 2u);
  EXPECT_NEAR(lines[0].true_hz[0], -91.0, 0.3);
  EXPECT_NEAR(lines[0].true_hz[1], 134.0, 0.3);
  EXPECT_LT(lines[0].margin, 0.03);
}

TEST(CameraLines, ALineThatFoldsBackwardsHasANegativeFrequency) {
  const auto lines = of_region({.rotor_hz = 91.0, .rotor_mm = 0.2}, 1);  // seen at 9 Hz
  ASSERT_EQ(lines.size(), 1u);
  ASSERT_FALSE(lines[0].true_hz.empty());
  EXPECT_NEAR(lines[0].true_hz.front(), -91.0, 0.3);
}

TEST(CameraLines, WithoutARegionTheRowsShowIt) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto lines = by_rows({.rotor_hz = 134.0, .rotor_mm = 0.05, .has_region = false}, seed);
    ASSERT_EQ(lines.size(), 1u) << seed;
    EXPECT_NEAR(lines[0].apparent_hz, 9.0, 1.0);
    EXPECT_NEAR(std::abs(lines[0].true_hz.front()), 134.0, 1.0);
  }
}

TEST(CameraLines, WithoutARotorNothingIsListed) {
  for (const bool has_region : {true, false}) {
    for (unsigned seed = 1; seed <= 20; ++seed)
      EXPECT_TRUE(listed({.has_region = has_region}, seed).empty()) << has_region << ' ' << seed;
  }
}

TEST(CameraLines, FewSegmentsListNothing) {
  EXPECT_FALSE(listed({.rotor_hz = 134.0, .rotor_mm = 0.2}, 1).empty());
  EXPECT_TRUE(listed({.seconds = 40.0, .rotor_hz = 134.0, .rotor_mm = 0.2}, 1).empty());
}

TEST(CameraLines, UnknownDelaysLeaveTheTrueFrequencyOpen) {
  const Flight flight{.rotor_hz = 134.0, .rotor_mm = 0.2, .is_declared = false};
  EXPECT_TRUE(by_rows(flight, 1).empty());
  const auto poles = listed(flight, 1);
  ASSERT_EQ(poles.size(), 1u);
  EXPECT_NEAR(poles[0].frequency_hz, 9.0, 0.3);
  EXPECT_FALSE(poles[0].fold_n.has_value());
  EXPECT_NE(poles[0].reason.find("its true frequency is open"), std::string::npos) << poles[0].reason;
}

TEST(CameraLines, AListedLineIsAPoleOfTheCamera) {
  const auto poles = listed({.rotor_hz = 134.0, .rotor_mm = 0.2}, 1);
  ASSERT_EQ(poles.size(), 1u);
  EXPECT_EQ(poles[0].verdict, Verdict::kCameraMotion);
  EXPECT_NEAR(poles[0].frequency_hz, 134.0, 0.3);
  EXPECT_EQ(poles[0].fold_n, 5);
  EXPECT_EQ(poles[0].shape.size(), kOutputs);
  EXPECT_NE(poles[0].reason.find("vibration of the camera at 134"), std::string::npos) << poles[0].reason;
}

TEST(CameraLines, OfAListedPoleTheReasonGetsTheTrueFrequency) {
  const Flight flight{.rotor_hz = 134.0, .rotor_mm = 0.2};
  ModalEstimate estimate;
  Mode pole;
  pole.apparent_hz = pole.frequency_hz = 9.0;
  pole.verdict = Verdict::kCameraMotion;
  pole.reason = "a static region moves with it";
  estimate.rejected = {pole};
  list_camera_lines(sums_of(flight, 1), channels(flight), folding_of(flight), estimate);
  ASSERT_EQ(estimate.rejected.size(), 1u);
  EXPECT_NE(estimate.rejected[0].reason.find("; by the rows' phases it vibrates at 134"), std::string::npos)
      << estimate.rejected[0].reason;
}

TEST(CameraLines, TheIdentifierListsThemBesideItsModes) {
  const Flight flight{.rotor_hz = 134.0, .rotor_mm = 0.2};
  const Identifier identifier(IdentifierConfig{}, channels(flight));
  const ModalEstimate estimate = identifier.identify(sums_of(flight, 1));
  ASSERT_EQ(estimate.modes.size(), 1u);
  EXPECT_NEAR(estimate.modes[0].frequency_hz, 5.0, 0.05);
  const auto is_rotor = [](const Mode& pole) {
    return pole.verdict == Verdict::kCameraMotion && pole.reason.find("134") != std::string::npos;
  };
  EXPECT_EQ(std::count_if(estimate.rejected.begin(), estimate.rejected.end(), is_rotor), 1);
}

}  // namespace
}  // namespace core
