#include "core/identification/phase_verdict.h"

#include <gtest/gtest.h>

#include <complex>

#include "core/identification/mac.h"
#include "core/identification/phase_line.h"

namespace core {
namespace {

using Complex = std::complex<double>;
using Shape = std::vector<Complex>;

Shape bent(double out_of_phase) { return {Complex(0.5, out_of_phase), Complex(-0.7, out_of_phase), 1.0}; }

Mode mode_of(Shape shape) {
  Mode mode;
  mode.verdict = Verdict::kStructural;
  mode.frequency_hz = 3.0, mode.damping_ratio = 0.01;
  mode.frequency_std_hz = 0.005, mode.damping_std = 0.002;
  mode.mpc = mpc(shape);
  mode.shape_std.assign(shape.size(), 0.3);
  mode.shape = std::move(shape);
  return mode;
}

Sigmas chance_of(double beside_line) {
  return {9.0, {ModeScatter{0.005, 0.002, {0.3, 0.3, 0.0}, {0.1, 0.1, 0.0}, beside_line}}};
}

TEST(PhaseLine, TheShareBesideItIsWhatMpcStates) {
  const Shape shape = bent(0.4);
  const Complex back = std::conj(phase_line(shape));
  double beside = 0.0, whole = 0.0;
  for (const Complex& z : shape) beside += std::pow((z * back).imag(), 2), whole += std::norm(z);
  EXPECT_NEAR(share_beside_line(mpc(shape)), beside / whole, 1e-12);
}

TEST(PhaseLine, AlongItAShapeIsRealAndItsLargestIsOne) {
  const Shape shape = bent(0.4), turned{shape[0] * Complex(0, 2), shape[1] * Complex(0, 2), shape[2] * Complex(0, 2)};
  const Shape along = along_phase_line(shape), of_turned = along_phase_line(turned);
  EXPECT_EQ(along[2], 1.0);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(along[c].imag(), 0.0);
    EXPECT_NEAR(along[c].real(), of_turned[c].real(), 1e-12);
  }
}

TEST(PhaseVerdict, PhasesBeyondChanceAreNoMode) {
  std::vector<Mode> modes{mode_of(bent(0.5))};
  ASSERT_LT(modes[0].mpc, 0.8);
  reject_out_of_phase(0.8, chance_of(0.01), modes);
  EXPECT_EQ(modes[0].verdict, Verdict::kNumerical);
  EXPECT_NE(modes[0].reason.find("not in phase"), std::string::npos);
  EXPECT_FALSE(modes[0].frequency_std_hz.has_value());
}

TEST(PhaseVerdict, PhasesWithinChanceAreNoEvidence) {
  std::vector<Mode> modes{mode_of(bent(0.5))};
  const Sigmas sigmas = chance_of(share_beside_line(modes[0].mpc));
  reject_out_of_phase(0.8, sigmas, modes);
  EXPECT_EQ(modes[0].verdict, Verdict::kStructural);
  EXPECT_NE(modes[0].reason.find("scatter"), std::string::npos) << modes[0].reason;
  state_along_line(sigmas, modes);
  EXPECT_EQ(modes[0].shape, along_phase_line(bent(0.5)));
  EXPECT_EQ(modes[0].shape_std[0], 0.1);
}

TEST(PhaseVerdict, ChanceIsNoExcuseWhereTheFrequencyIsUnknown) {
  std::vector<Mode> modes{mode_of(bent(0.5))};
  modes[0].frequency_std_hz = 0.02;  // zeta f = 0.03
  reject_out_of_phase(0.8, chance_of(0.5), modes);
  EXPECT_EQ(modes[0].verdict, Verdict::kNumerical);
}

TEST(PhaseVerdict, TheAliasOrderOfAFoldedModeNeedsPhases) {
  std::vector<Mode> modes{mode_of(bent(0.2))};
  ASSERT_GT(modes[0].mpc, 0.8);
  ASSERT_LT(modes[0].mpc, 0.85);
  modes[0].fold_margin = 0.6;
  reject_out_of_phase(0.8, chance_of(1e-4), modes);
  EXPECT_EQ(modes[0].verdict, Verdict::kStructural) << "not folded";
  modes[0].fold_n = -1;
  std::vector<Mode> again = modes, clear = modes;
  reject_out_of_phase(0.8, chance_of(1e-4), modes);
  EXPECT_EQ(modes[0].verdict, Verdict::kAmbiguous);
  clear[0].fold_margin = 0.7;
  reject_out_of_phase(0.8, chance_of(1e-4), clear);
  EXPECT_EQ(clear[0].verdict, Verdict::kStructural) << "every other alias order is far worse";
  reject_out_of_phase(0.8, chance_of(0.1), again);
  EXPECT_EQ(again[0].verdict, Verdict::kStructural) << "within chance";
}

TEST(PhaseVerdict, WithoutSigmaMpcDecides) {
  std::vector<Mode> modes{mode_of(bent(0.5)), mode_of(bent(0.05))};
  reject_out_of_phase(0.8, {0.0, {std::nullopt, std::nullopt}}, modes);
  EXPECT_EQ(modes[0].verdict, Verdict::kNumerical);
  EXPECT_EQ(modes[1].verdict, Verdict::kStructural);
}

TEST(PhaseVerdict, ATrulyComplexShapeStaysComplex) {
  std::vector<Mode> modes{mode_of(bent(0.2))};
  state_along_line(chance_of(1e-5), modes);
  EXPECT_EQ(modes[0].shape, bent(0.2));
}

}  // namespace
}  // namespace core
