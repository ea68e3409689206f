#include "core/identification/merge_setups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "core/identification/mac.h"

namespace core {
namespace {

using Shape = std::vector<std::complex<double>>;

Mode mode(double frequency_hz, double damping_ratio, Shape shape) {
  Mode m;
  m.frequency_hz = m.apparent_hz = frequency_hz;
  m.damping_ratio = damping_ratio;
  m.shape = std::move(shape);
  m.mpc = 1.0;
  m.presence = 1.0;
  m.verdict = Verdict::kStructural;
  return m;
}

// Channels: one that moves from set-up to set-up and two references.
SetupModes setup(const std::string& name, double duration_s, std::vector<Mode> modes) {
  SetupModes s;
  s.name = name;
  for (const char* channel : {"moved", "ref_x", "ref_y"}) s.channels.emplace_back().name = channel;
  s.references = {"ref_x", "ref_y"};
  s.estimate.duration_s = duration_s;
  s.estimate.rate_hz = 32.0;
  s.estimate.modes = std::move(modes);
  return s;
}

// A bending mode in x, one in y close to it; each set-up sees another point and scales shapes differently.
std::vector<SetupModes> two_setups() {
  const std::complex<double> turned = std::polar(2.0, 1.0);
  return {setup("a", 100.0, {mode(2.00, 0.010, {0.5, 1.0, 0.1}), mode(2.03, 0.020, {0.3, -0.1, 1.0})}),
          setup("b", 300.0,
                {mode(2.01, 0.014, {0.8 * turned, 1.0 * turned, 0.1 * turned}), mode(2.04, 0.024, {-0.6, 0.1, -1.0})})};
}

TEST(MergeSetups, AveragesWeighByDuration) {
  const MergedSetups merged = merge_setups(two_setups());
  ASSERT_EQ(merged.estimate.modes.size(), 2U);
  EXPECT_NEAR(merged.estimate.modes[0].frequency_hz, 0.25 * 2.00 + 0.75 * 2.01, 1e-12);
  EXPECT_NEAR(merged.estimate.modes[0].damping_ratio, 0.25 * 0.010 + 0.75 * 0.014, 1e-12);
  EXPECT_EQ(merged.estimate.duration_s, 400.0);
  EXPECT_EQ(merged.estimate.status, "ok");
}

TEST(MergeSetups, ShapesAreJoinedAtTheReferences) {
  const MergedSetups merged = merge_setups(two_setups());
  ASSERT_EQ(merged.channels.size(), 4U);
  EXPECT_EQ(merged.channels[0].name, "ref_x");
  EXPECT_EQ(merged.channels[1].name, "ref_y");
  EXPECT_EQ(merged.channels[2].name, "a.moved");
  EXPECT_EQ(merged.channels[3].name, "b.moved");
  ASSERT_EQ(merged.estimate.modes.size(), 2U);
  EXPECT_NEAR(mac(merged.estimate.modes[0].shape, Shape{1.0, 0.1, 0.5, 0.8}), 1.0, 1e-12);
  EXPECT_NEAR(mac(merged.estimate.modes[1].shape, Shape{-0.1, 1.0, 0.3, 0.6}), 1.0, 1e-12);
  EXPECT_NEAR(merged.estimate.modes[0].mpc, 1.0, 1e-12);
}

TEST(MergeSetups, CloseModesAreToldApartByTheirReferenceParts) {
  std::vector<SetupModes> setups = two_setups();
  // The order of the frequencies differs from that of the modes.
  setups[1].estimate.modes[0].frequency_hz = 2.05;
  const MergedSetups merged = merge_setups(setups);
  ASSERT_EQ(merged.estimate.modes.size(), 2U);
  for (const Mode& m : merged.estimate.modes) {
    const bool is_x = std::abs(m.shape[0]) > std::abs(m.shape[1]);
    EXPECT_NEAR(m.frequency_hz, is_x ? 0.25 * 2.00 + 0.75 * 2.05 : 0.25 * 2.03 + 0.75 * 2.04, 1e-12);
  }
}

TEST(MergeSetups, AModeThatASetupLacksIsListedWithTheReason) {
  std::vector<SetupModes> setups = two_setups();
  setups[1].estimate.modes.pop_back();
  const MergedSetups merged = merge_setups(setups);
  EXPECT_EQ(merged.estimate.modes.size(), 1U);
  ASSERT_EQ(merged.estimate.rejected.size(), 1U);
  EXPECT_NEAR(merged.estimate.rejected[0].frequency_hz, 2.03, 1e-12);
  EXPECT_NE(merged.estimate.rejected[0].verdict, Verdict::kStructural);
  EXPECT_THAT(merged.estimate.rejected[0].reason, testing::HasSubstr("only in a"));
}

TEST(MergeSetups, TwoModesOfOneSetupNeverBecomeOne) {
  std::vector<SetupModes> setups = two_setups();
  setups[0].estimate.modes.push_back(mode(2.005, 0.01, {0.5, 1.0, 0.1}));
  const MergedSetups merged = merge_setups(setups);
  EXPECT_EQ(merged.estimate.modes.size(), 2U);
  EXPECT_EQ(merged.estimate.rejected.size(), 1U);
}

TEST(MergeSetups, StandardDeviationsAreThoseOfTheMean) {
  std::vector<SetupModes> setups = two_setups();
  for (SetupModes& s : setups) {
    for (Mode& m : s.estimate.modes) m.frequency_std_hz = m.damping_std = 0.004;
  }
  const MergedSetups merged = merge_setups(setups);
  ASSERT_TRUE(merged.estimate.modes[0].frequency_std_hz.has_value());
  EXPECT_NEAR(*merged.estimate.modes[0].frequency_std_hz, 0.004 * std::hypot(0.25, 0.75), 1e-12);
  setups[0].estimate.modes[0].frequency_std_hz.reset();
  EXPECT_FALSE(merge_setups(setups).estimate.modes[0].frequency_std_hz.has_value());
}

TEST(MergeSetups, NoCommonModeIsAStatus) {
  std::vector<SetupModes> setups = two_setups();
  for (Mode& m : setups[1].estimate.modes) m.frequency_hz *= 1.5;
  const MergedSetups merged = merge_setups(setups);
  EXPECT_TRUE(merged.estimate.modes.empty());
  EXPECT_NE(merged.estimate.status, "ok");
  EXPECT_EQ(merged.estimate.rejected.size(), 4U);
}

TEST(MergeSetups, AReferenceThatStandsStillMakesNoNaN) {
  std::vector<SetupModes> setups = two_setups();
  for (SetupModes& s : setups) {
    for (Mode& m : s.estimate.modes) m.shape[1] = m.shape[2] = 0.0;
    s.estimate.duration_s = 0.0;
  }
  const MergedSetups merged = merge_setups(setups);
  for (const auto* list : {&merged.estimate.modes, &merged.estimate.rejected}) {
    for (const Mode& m : *list) {
      EXPECT_TRUE(std::isfinite(m.frequency_hz) && std::isfinite(m.damping_ratio) && std::isfinite(m.mpc));
      for (const auto& z : m.shape) EXPECT_TRUE(std::isfinite(std::abs(z)));
    }
  }
}

TEST(MergeSetups, RefusesWithTheNameOfWhatIsMissing) {
  std::vector<SetupModes> setups = two_setups();
  EXPECT_THROW(static_cast<void>(merge_setups({setups[0]})), std::invalid_argument);
  setups[1].channels[2].name = "elsewhere";
  try {
    static_cast<void>(merge_setups(setups));
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("set-up b"), testing::HasSubstr("ref_y")));
  }
  setups = two_setups();
  for (SetupModes& s : setups) s.references.clear();
  EXPECT_THROW(static_cast<void>(merge_setups(setups)), std::invalid_argument);
}

}  // namespace
}  // namespace core
