#include <gtest/gtest.h>

#include <cmath>

#include "core/structure/effects/catalogue.h"
#include "core/structure/kinds/beam.h"
#include "core/structure/kinds/cable.h"
#include "core/structure/mode_numbers.h"
#include "core/structure/paired_fit.h"
#include "core/structure/place_profile.h"

namespace core::structure {
namespace {

using Eigen::Index;

DeclaredFrame bridge(double spring_prior = 0.0) {
  Beam beam;
  beam.spans = {{10.0, 2.0e6, 50.0, 5}};
  beam.supports.resize(2);
  beam.supports[1].displacement = Connection::spring(3.0e5);
  beam.spring_prior = spring_prior;
  std::vector<Sight> sights;
  for (int i = 0; i < 6; ++i)
    sights.push_back({"r" + std::to_string(i), {1.0 + 1.6 * i, 0, 0}, Eigen::Vector3d::UnitZ()});
  return declare(make_beam(beam, std::move(sights)), 6);
}

const StructuralEffect& effect(const char* name) {
  return *core::find_effect(structural_effects(), name, [](const auto& one) { return one.name(); });
}

// The modes of the declared model with one of its parameters changed, exact.
std::vector<ReferenceMode> reference_of(const DeclaredFrame& declared, const std::string& parameter, double value) {
  Eigen::VectorXd values = declared_values(*declared.model);
  for (std::size_t i = 0; i < declared.model->parameters().size(); ++i) {
    if (declared.model->parameters()[i].name == parameter) values(static_cast<Index>(i)) = value;
  }
  const auto modes = declared.model->modes(values, 5, {});
  std::vector<ReferenceMode> out;
  for (Index r = 0; r < modes->frequency_hz.size(); ++r) {
    ReferenceMode mode;
    mode.number = static_cast<int>(r) + 1;
    mode.frequency_hz = modes->frequency_hz(r);
    mode.sigma_hz = 1e-3 * mode.frequency_hz;
    for (Index i = 0; i < modes->shapes.rows(); ++i) {
      mode.shape.push_back(modes->shapes(i, r) / modes->shapes.col(r).cwiseAbs().maxCoeff());
      mode.shape_sigma.push_back(0.01);
    }
    out.push_back(std::move(mode));
  }
  return out;
}

TEST(PlacedEffects, TheSoftPartIsFoundWithItsSize) {
  const DeclaredFrame declared = bridge();
  const auto reference = reference_of(declared, "stiffness_4", 0.7);
  const FrameModel model{&declared, {&effect("soft_part")}};
  const FrameFit fit = fit_frame(model, reference, {}, Starts::kAll);
  ASSERT_TRUE(fit.ok);
  EXPECT_LT(fit.chi2, 1e-6);
  EXPECT_EQ(fit.parameters(1), 4.0);
  EXPECT_NEAR(fit.parameters(2), 0.7, 1e-5);
  const Eigen::VectorXd sigmas = parameter_sigmas(fit);
  EXPECT_TRUE(std::isnan(sigmas(1)));
  EXPECT_GT(sigmas(2), 0.0);
  std::size_t like = 0;
  for (const PlaceFit& place : place_profile(model, reference, fit, 0, 1.0)) like += place.is_indistinguishable ? 1 : 0;
  EXPECT_EQ(like, 1U);
}

TEST(PlacedEffects, EachEffectIsFoundByItsOwnParameter) {
  const DeclaredFrame declared = bridge();
  const struct {
    const char *effect, *parameter;
    double value;
  } cases[] = {{"added_mass", "mass_3", 40.0},
               {"support_yielding", "support_1_displacement_flexibility", 2e-6},
               {"support_restraint", "support_1_rotation_stiffness", 2e5},
               {"spring_stiffness", "support_2_displacement_stiffness", 1.8e5},
               {"axial_force", "axial_force", -4e4}};
  for (const auto& one : cases) {
    const auto reference = reference_of(declared, one.parameter, one.value);
    const FrameModel model{&declared, {&effect(one.effect)}};
    const FrameFit fit = fit_frame(model, reference, {}, Starts::kAll);
    ASSERT_TRUE(fit.ok) << one.effect;
    EXPECT_LT(fit.chi2, 1e-3) << one.effect;
    const Eigen::VectorXd values = values_of(model, fit.parameters);
    for (std::size_t i = 0; i < declared.model->parameters().size(); ++i) {
      if (declared.model->parameters()[i].name != one.parameter) continue;
      EXPECT_NEAR(values(static_cast<Index>(i)) / one.value, 1.0, 1e-2) << one.effect;
    }
  }
}

TEST(PlacedEffects, APriorIsDataAndItsPosteriorIsNarrower) {
  const DeclaredFrame declared = bridge(0.5);
  const auto reference = reference_of(declared, "support_2_displacement_stiffness", 2.0e5);
  const FrameModel model{&declared, {}};
  ASSERT_EQ(model.with_prior().size(), 1U);
  const FrameFit fit = fit_frame(model, reference, {}, Starts::kAll);
  ASSERT_TRUE(fit.ok);
  const Eigen::VectorXd values = values_of(model, fit.parameters);
  EXPECT_NEAR(values(static_cast<Index>(model.with_prior().front())), 2.0e5, 5e3);
  EXPECT_LT(identifiability(model, fit).front().sigma_over_prior, 0.2);
}

TEST(PlacedEffects, ACablesTensionHasTheSigmaOfItsFrequencies) {
  Cable cable;
  cable.length_m = 100.0, cable.mass_per_m_kg = 60.0, cable.tension_n = 2.0e6, cable.tension_prior = 1.0;
  DeclaredFrame declared = declare(make_cable(cable, {}), 5);
  declared.stiffness_over_mass_per_s2 = 1.0;
  auto reference = reference_of(declared, "tension", 3.0e6);
  for (auto& mode : reference) mode.shape.clear(), mode.shape_sigma.clear();
  const FrameModel model{&declared, {}};
  const FrameFit fit = fit_frame(model, reference, {}, Starts::kAll);
  ASSERT_TRUE(fit.ok);
  EXPECT_NEAR(values_of(model, fit.parameters)(0), 3.0e6, 100.0);
  // f goes with the root of the tension: relative sigma twice that of the mean frequency.
  const double sigma = identifiability(model, fit).front().sigma_over_prior * cable.tension_n;
  EXPECT_NEAR(sigma / 3.0e6, 2.0 * 1e-3 / std::sqrt(5.0), 1e-5);
}

// Stiffness known and no prior: nothing is fitted before an effect is.
TEST(PlacedEffects, AModelWithoutFreeParametersIsComparedAsItIs) {
  DeclaredFrame declared = bridge();
  const auto reference = reference_of(declared, "stiffness_4", 0.7);
  declared.stiffness_over_mass_per_s2 = 1.0;
  const FrameFit plain = fit_frame({&declared, {}}, reference, {}, Starts::kAll);
  ASSERT_TRUE(plain.ok);
  EXPECT_EQ(plain.parameters.size(), 0);
  const FrameFit soft = fit_frame({&declared, {&effect("soft_part")}}, reference, plain.parameters, Starts::kAll);
  ASSERT_TRUE(soft.ok);
  EXPECT_EQ(soft.parameters(0), 4.0);
  EXPECT_NEAR(soft.parameters(1), 0.7, 1e-5);
}

TEST(ModeNumbers, MissingAndAdditionalModesArePairedByShape) {
  const DeclaredFrame declared = bridge();
  auto reference = reference_of(declared, "stiffness_2", 0.8);
  for (auto& mode : reference) mode.frequency_hz *= 1.1;  // another common factor
  reference.erase(reference.begin() + 1);                 // mode 2 was not measured
  ReferenceMode foreign = reference.front();
  foreign.frequency_hz *= 1.7;
  for (std::size_t i = 0; i < foreign.shape.size(); ++i) foreign.shape[i] = i % 2 == 0 ? 1.0 : -1.0;
  reference.insert(reference.begin() + 1, foreign);
  const auto left = pair_with_model(declared, reference);
  ASSERT_EQ(left.size(), 1U);
  EXPECT_EQ(left.front().frequency_hz, foreign.frequency_hz);
  ASSERT_EQ(reference.size(), 4U);
  const int expected[] = {1, 3, 4, 5};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(reference[i].number, expected[i]);
}

TEST(ModeNumbers, SwappedNeighboursKeepTheirShapes) {
  ModelModes known, modes;
  known.frequency_hz = Eigen::Vector2d(1.0, 1.05), modes.frequency_hz = Eigen::Vector2d(1.0, 1.02);
  known.shapes = Eigen::Matrix2d::Identity();
  modes.shapes.resize(2, 2);
  modes.shapes << 0.1, 1.0, 1.0, 0.1;
  number_as(known, modes);
  EXPECT_EQ(modes.frequency_hz(0), 1.02);
  EXPECT_EQ(modes.shapes(0, 0), 1.0);
}

// The support yields so much that the declared model's nearest modes are others.
TEST(PairedFit, ModesThatAnEffectMovedFarGetTheirOwnNumbers) {
  DeclaredFrame declared = bridge();
  declared.stiffness_over_mass_per_s2 = 1.0;
  const auto measured = reference_of(declared, "support_1_displacement_flexibility", 2e-5);
  auto paired = measured;
  (void)pair_with_model(declared, paired);
  std::vector<int> number(measured.size(), 0), own;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    for (const auto& mode : paired) {
      if (mode.frequency_hz == measured[i].frequency_hz) number[i] = mode.number;
    }
    own.push_back(measured[i].number);
  }
  ASSERT_NE(number, own);
  const PairedFit without = fit_paired({&declared, {}}, measured, number, Eigen::VectorXd());
  const PairedFit with = fit_paired({&declared, {&effect("support_yielding")}}, measured, number, Eigen::VectorXd());
  ASSERT_TRUE(with.fit.ok);
  EXPECT_EQ(with.number, own);
  EXPECT_LT(with.fit.chi2, 1e-3);
  EXPECT_TRUE(!without.fit.ok || without.cost > with.cost);
}

}  // namespace
}  // namespace core::structure
