#include "core/structure/first_order.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/closure/closure_loop.h"
#include "core/closure/noise_stream.h"
#include "core/closure/structure_level.h"
#include "core/structure/effects/catalogue.h"
#include "core/structure/kinds/beam.h"

namespace core::structure {
namespace {

using Eigen::Index;

constexpr int kParts = 8, kModes = 5;

DeclaredFrame ten_metres() {
  Beam beam;
  beam.spans = {{10.0, 2.0e6, 50.0, kParts}};
  beam.supports.resize(2);
  std::vector<Sight> sights;
  for (int i = 0; i < kParts; ++i)
    sights.push_back({"r" + std::to_string(i), {0.7 + 1.2 * i, 0, 0}, Eigen::Vector3d::UnitZ()});
  return declare(make_beam(beam, std::move(sights)), kModes);
}

// Modes with one part at a share of its stiffness, and noise of the stated size times `noise`.
std::vector<ReferenceMode> measured(const DeclaredFrame& declared, int part, double share, double noise,
                                    std::uint64_t seed) {
  Eigen::VectorXd values = declared_values(*declared.model);
  values(static_cast<Index>(parameters_of(*declared.model, Role::kPartStiffness)[static_cast<std::size_t>(part) - 1])) =
      share;
  const auto modes = declared.model->modes(values, kModes, {});
  closure::NoiseStream draw(seed);
  std::vector<ReferenceMode> out;
  for (Index r = 0; r < kModes; ++r) {
    ReferenceMode mode;
    mode.number = static_cast<int>(r) + 1;
    mode.frequency_hz = modes->frequency_hz(r) * (1.0 + 1e-3 * noise * draw.gaussian());
    mode.sigma_hz = 1e-3 * mode.frequency_hz;
    for (Index i = 0; i < modes->shapes.rows(); ++i) {
      mode.shape.push_back(modes->shapes(i, r) / modes->shapes.col(r).cwiseAbs().maxCoeff() +
                           0.01 * noise * draw.gaussian());
      mode.shape_sigma.push_back(0.01);
    }
    out.push_back(std::move(mode));
  }
  return out;
}

std::vector<const StructuralEffect*> one(const char* name) {
  return {core::find_effect(structural_effects(), name, [](const auto& e) { return e.name(); })};
}

TEST(FirstOrder, HeldOutSquaresAreThoseOfFitsWithoutEachMode) {
  const DeclaredFrame declared = ten_metres();
  const auto reference = measured(declared, 3, 1.0, 1.0, 7);
  const FrameModel model{&declared, {}};
  const FrameFit fit = fit_frame(model, reference, {}, Starts::kAll);
  const auto held = HeldOutModes::about(model, reference, fit);
  ASSERT_TRUE(held);
  EXPECT_NEAR(held->chi2(held->fitted_residuals(fit.residuals)) / leave_one_out(model, reference, fit).chi2, 1.0, 2e-3);
}

TEST(FirstOrder, HeldOutSquaresWithAnEffectAreThoseOfLimitedFits) {
  const DeclaredFrame declared = ten_metres();
  const auto reference = measured(declared, 3, 0.9, 1.0, 7);
  const FrameModel soft{&declared, one("soft_part")};
  const FrameFit fit = fit_frame(soft, reference, {}, Starts::kAll);
  const auto held = HeldOutModes::about(soft, reference, fit);
  ASSERT_TRUE(held);
  EXPECT_NEAR(held->chi2(held->fitted_residuals(fit.residuals)) / leave_one_out(soft, reference, fit).chi2, 1.0, 0.05);
}

// Two modes of three do not show a stiffness that the third alone would change.
TEST(FirstOrder, AnEffectInAFitWithoutAModeIsNoLargerThanWithAllModes) {
  const DeclaredFrame declared = ten_metres();
  const auto reference = measured(declared, 3, 0.9, 1.0, 7);
  FrameModel soft{&declared, one("soft_part")};
  const FrameFit fit = fit_frame(soft, reference, {}, Starts::kAll);
  const Eigen::VectorXd limits = soft.limits_at(fit.parameters);
  EXPECT_TRUE(std::isinf(limits(soft.n_parameters() - 2)));  // the place
  EXPECT_DOUBLE_EQ(limits(soft.n_parameters() - 1), std::abs(fit.parameters(soft.n_parameters() - 1) - 1.0));
  soft.limits = limits;
  const FrameFit none = fit_frame(soft, {reference[0]}, fit.parameters, Starts::kBest, 0);
  ASSERT_TRUE(none.ok);
  EXPECT_NEAR(none.parameters(soft.n_parameters() - 1), 1.0, 1e-6);
}

TEST(FirstOrder, TheGainOfASmallChangeIsThatOfTheFit) {
  const DeclaredFrame declared = ten_metres();
  const auto reference = measured(declared, 3, 0.98, 0.0, 7);
  const FrameModel plain{&declared, {}}, soft{&declared, one("soft_part")};
  const FrameFit before = fit_frame(plain, reference, {}, Starts::kAll);
  const FrameFit after = fit_frame(soft, reference, before.parameters, Starts::kAll);
  const auto effects = FirstOrderEffects::about(plain, soft.effects, reference, before);
  ASSERT_TRUE(effects);
  EXPECT_NEAR(effects->largest_gain(before.residuals) / (before.chi2 - after.chi2), 1.0, 0.05);
  const double score = leave_one_out(plain, reference, before).chi2 - leave_one_out(soft, reference, after).chi2;
  EXPECT_NEAR(effects->largest_score(before.residuals) / score, 1.0, 0.05);
}

TEST(FirstOrder, AnEffectThatCannotBeNegativeGainsNothingFromItsOpposite) {
  const DeclaredFrame declared = ten_metres();
  const auto reference = measured(declared, 3, 1.0, 0.0, 7);
  const FrameModel plain{&declared, {}};
  const FrameFit fit = fit_frame(plain, reference, {}, Starts::kAll);
  const auto effects = FirstOrderEffects::about(plain, one("support_restraint"), reference, fit);
  ASSERT_TRUE(effects);
  // Both hinges restrained raise the low frequencies, in proportion to nothing else.
  Eigen::VectorXd data = Eigen::VectorXd::Zero(fit.n_data);
  data(0) = -3.0;
  const double one_way = effects->largest_gain(data), other_way = effects->largest_gain(-data);
  EXPECT_GT(std::max(one_way, other_way), 1.0);
  EXPECT_LT(std::min(one_way, other_way), 0.1 * std::max(one_way, other_way));
}

// The residual as a whole is no more than noise: only its direction tells.
TEST(FirstOrder, ALossBelowTheNoiseOfAllDataIsFoundInItsPlace) {
  const DeclaredFrame declared = ten_metres();
  const auto reference = measured(declared, 4, 0.96, 1.0, 11);
  const FrameModel plain{&declared, {}};
  const FrameFit fit = fit_frame(plain, reference, {}, Starts::kAll);
  ASSERT_LT(fit.chi2, chi2_limit(fit.degrees_of_freedom()));
  closure::StructureLevel level(declared, reference);
  closure::ClosureOptions options;
  options.n_surrogates_when_plain = 32;
  const auto result = closure::close_loop(level, options);
  ASSERT_EQ(result.steps.size(), 1U);
  EXPECT_EQ(result.steps[0].effect, "soft_part");
  EXPECT_NEAR(result.steps[0].parameters[0].value, 4.0, 1.0);
  EXPECT_LT(result.steps[0].parameters[1].value, 1.0);
}

TEST(FirstOrder, TooFewModesHaveNone) {
  const DeclaredFrame declared = ten_metres();
  auto reference = measured(declared, 3, 1.0, 0.0, 7);
  reference.resize(1);
  const FrameModel plain{&declared, {}};
  const FrameFit fit = fit_frame(plain, reference, {}, Starts::kAll);
  EXPECT_FALSE(HeldOutModes::about(plain, reference, fit));
}

}  // namespace
}  // namespace core::structure
