#include "core/structure/effects/catalogue.h"
#include "core/structure/frame_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace core::structure {
namespace {

const StructuralEffect* named(const std::string& name) {
  for (const auto& effect : structural_effects()) {
    if (effect->name() == name) return effect.get();
  }
  return nullptr;
}

std::vector<ReferenceMode> reference_of(const FrameModes& modes, double sigma) {
  std::vector<ReferenceMode> out;
  for (Eigen::Index r = 0; r < modes.frequency_hz.size(); ++r) {
    ReferenceMode mode;
    mode.number = static_cast<int>(r) + 1;
    mode.frequency_hz = modes.frequency_hz(r);
    mode.sigma_hz = sigma * mode.frequency_hz;
    out.push_back(mode);
  }
  return out;
}

class FrameFitTest : public ::testing::Test {
 protected:
  FrameFitTest() {
    declared_.n_storeys = 6;
    declared_.simulated = true;
  }
  FrameModel model(const std::vector<std::string>& names) {
    FrameModel out{&declared_, {}};
    for (const auto& name : names) out.effects.push_back(named(name));
    return out;
  }
  DeclaredFrame declared_;
};

TEST_F(FrameFitTest, EveryEffectIsFoundAgainFromItsOwnModes) {
  const std::vector<std::pair<std::string, double>> truths{
      {"ground_storey", 0.6}, {"gravity_softening", 60.0}, {"joint_rotation", 0.1}, {"base_rocking", 0.01},
      {"roof_mass", 1.5},     {"column_bending", 0.01},    {"integrator", 0.02}};
  for (const auto& [name, truth] : truths) {
    const FrameModel wanted = model({name});
    Eigen::VectorXd p(2);
    p << std::log(1800.0), truth;
    const auto modes = seen_modes(wanted, p, false);
    ASSERT_TRUE(modes) << name;
    const auto reference = reference_of(*modes, 0.0015);
    const FrameFit plain = fit_frame(model({}), reference, {}, Starts::kAll);
    const FrameFit fit = fit_frame(wanted, reference, plain.parameters, Starts::kAll);
    ASSERT_TRUE(fit.ok) << name;
    EXPECT_NEAR(fit.parameters(1) / truth, 1.0, 1e-3) << name;
    EXPECT_NEAR(fit.parameters(0), std::log(1800.0), 1e-3) << name;
    EXPECT_LT(leave_one_out(wanted, reference, fit).rms_percent, 0.05) << name;
  }
}

TEST_F(FrameFitTest, JacobianIsThatOfTheResiduals) {
  const FrameModel wanted = model({"ground_storey"});
  Eigen::VectorXd p(2);
  p << std::log(900.0), 0.8;
  auto reference = reference_of(*seen_modes(wanted, p, false), 0.01);
  reference[2].frequency_hz *= 1.01;
  const FrameFit fit = fit_frame(wanted, reference, {}, Starts::kAll);
  ASSERT_TRUE(fit.ok);
  // d ln f / d ln k = 1/2, in sigmas of 1 %, times model over reference, which is near one.
  for (Eigen::Index i = 0; i < 6; ++i) EXPECT_NEAR(fit.jacobian(i, 0), 50.0, 1.0);
}

TEST_F(FrameFitTest, SigmasAreInfiniteInSpiritWhereDataDoNotFixAParameter) {
  declared_.n_storeys = 2;
  const FrameModel wanted = model({"ground_storey", "roof_mass"});
  Eigen::VectorXd p(3);
  p << std::log(900.0), 0.8, 1.2;
  const auto reference = reference_of(*seen_modes(wanted, p, false), 0.01);
  const FrameFit fit = fit_frame(wanted, reference, p, Starts::kAll);
  ASSERT_TRUE(fit.ok);
  const Eigen::VectorXd sigmas = parameter_sigmas(fit);
  for (const double sigma : sigmas) EXPECT_TRUE(std::isnan(sigma));
  EXPECT_TRUE(std::isinf(leave_one_out(wanted, reference, fit).rms_percent));
}

TEST_F(FrameFitTest, BoundsAreKept) {
  Eigen::VectorXd p(1);
  p << std::log(1800.0);
  auto reference = reference_of(*seen_modes(model({}), p, false), 0.0015);
  for (std::size_t i = 0; i < reference.size(); ++i)  // the opposite of softening
    reference[i].frequency_hz *= 1.0 + 0.01 * static_cast<double>(reference.size() - i);
  const FrameFit fit = fit_frame(model({"gravity_softening"}), reference, p, Starts::kAll);
  ASSERT_TRUE(fit.ok);
  EXPECT_EQ(fit.parameters(1), 0.0);
  EXPECT_FALSE(
      named("gravity_softening")->implausible({&fit.parameters(1), 1}, declared_, frame_of(model({}), p)).empty());
}

TEST(DeclaredFrameTest, RefusesWhatNoFrameCanBe) {
  DeclaredFrame frame;
  EXPECT_THROW(validate(frame), std::invalid_argument);
  frame.n_storeys = 3;
  EXPECT_NO_THROW(validate(frame));
  frame.mass = {1.0, 2.0};
  EXPECT_THROW(validate(frame), std::invalid_argument);
  frame.mass = {1.0, 2.0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_THROW(validate(frame), std::invalid_argument);
  frame.mass.clear();
  frame.frequency_sigma = 0.0;
  EXPECT_THROW(validate(frame), std::invalid_argument);
}

TEST(DeclaredFrameTest, RefusesReferencesOfAnotherStructure) {
  DeclaredFrame frame;
  frame.n_storeys = 2;
  const auto mode = [](int number, double hz) {
    ReferenceMode m;
    m.number = number;
    m.frequency_hz = hz;
    m.sigma_hz = 0.001 * std::abs(hz);
    return m;
  };
  EXPECT_NO_THROW(validate(frame, {mode(1, 1.0), mode(2, 2.0)}));
  EXPECT_THROW(validate(frame, {}), std::invalid_argument);
  EXPECT_THROW(validate(frame, {mode(1, 1.0)}), std::invalid_argument);
  EXPECT_THROW(validate(frame, {mode(1, 1.0), mode(3, 2.0)}), std::invalid_argument);
  EXPECT_THROW(validate(frame, {mode(1, 1.0), mode(1, 2.0)}), std::invalid_argument);
  EXPECT_THROW(validate(frame, {mode(2, 1.0), mode(1, 2.0)}), std::invalid_argument);
  EXPECT_THROW(validate(frame, {mode(1, 2.0), mode(2, 1.0)}), std::invalid_argument);
  EXPECT_THROW(validate(frame, {mode(1, std::numeric_limits<double>::quiet_NaN()), mode(2, 1.0)}),
               std::invalid_argument);
  EXPECT_THROW(validate(frame, {mode(1, -1.0), mode(2, 1.0)}), std::invalid_argument);
  auto shaped = mode(2, 2.0);
  shaped.shape = {1.0};
  shaped.shape_sigma = {0.1};
  EXPECT_THROW(validate(frame, {mode(1, 1.0), shaped}), std::invalid_argument);
}

TEST(FrameFitStatistics, ChiSquareLimitIsThatOfTables) {
  // Quantiles 0.997 of chi-square: 8.807 (1), 11.618 (2), 17.958 (5), 26.611 (10 degrees of freedom).
  EXPECT_NEAR(chi2_limit(1.0), 8.807, 0.15);
  EXPECT_NEAR(chi2_limit(2.0), 11.618, 0.15);
  EXPECT_NEAR(chi2_limit(5.0), 17.958, 0.15);
  EXPECT_NEAR(chi2_limit(10.0), 26.611, 0.15);
}

}  // namespace
}  // namespace core::structure
