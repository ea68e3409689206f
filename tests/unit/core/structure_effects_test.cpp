#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/structure/effects/catalogue.h"
#include "core/structure/frame_fit.h"
#include "core/structure/kinds/beam.h"
#include "core/structure/kinds/cable.h"
#include "core/structure/kinds/frame2d.h"
#include "core/structure/kinds/matrices.h"
#include "core/structure/kinds/shear_storeys.h"
#include "core/structure/kinds/tower.h"

namespace core::structure {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using ::testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

const StructuralEffect& structural(const char* name) {
  return *core::find_effect(structural_effects(), name, [](const auto& one) { return one.name(); });
}

Index index_of(const StructuralModel& model, const std::string& parameter) {
  for (std::size_t i = 0; i < model.parameters().size(); ++i) {
    if (model.parameters()[i].name == parameter) return static_cast<Index>(i);
  }
  return -1;
}

VectorXd hz_of(const StructuralModel& model, const VectorXd& values, std::size_t n = 5) {
  const auto modes = model.modes(values, n, {});
  return modes ? modes->frequency_hz : VectorXd();
}
VectorXd hz_with(const StructuralModel& model, const std::string& parameter, double value, std::size_t n = 5) {
  VectorXd values = declared_values(model);
  values(index_of(model, parameter)) = value;
  return hz_of(model, values, n);
}

void expect_equal(const VectorXd& a, const VectorXd& b, double relative, const std::string& what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  ASSERT_GT(a.size(), 0) << what;
  for (Index r = 0; r < a.size(); ++r) EXPECT_NEAR(a(r) / b(r), 1.0, relative) << what << ", mode " << r + 1;
}

Beam unit_beam(std::size_t parts, bool clamped) {
  Beam out;
  out.spans = {{1.0, 1.0, 1.0, parts}};
  out.supports.resize(2);
  if (clamped) {
    for (auto& support : out.supports) support.rotation = Connection::rigid();
  }
  return out;
}

// Simply supported, without rotary inertia: w^2 = q^4 / (1 + q^2 E I / (kappa G A)), q = n pi / L.
TEST(ShearFlexibility, HasTheClosedFormOfAHingedBar) {
  for (const std::size_t parts : {1U, 3U, 6U}) {
    const auto model = make_beam(unit_beam(parts, false), {});
    for (const double flexibility : {1e-4, 3e-3, 2e-2}) {
      VectorXd exact(4);
      for (Index n = 0; n < 4; ++n) {
        const double q = kPi * static_cast<double>(n + 1);
        exact(n) = q * q / std::sqrt(1.0 + q * q * flexibility) / (2.0 * kPi);
      }
      expect_equal(hz_with(*model, "shear_flexibility", flexibility, 4), exact, 1e-5,
                   std::to_string(parts) + " parts, " + std::to_string(flexibility));
    }
  }
}

// In series or declared as Timoshenko's bar: two formulations of one thing.
TEST(ShearFlexibility, IsThatOfADeclaredShearStiffness) {
  Tower tower;
  tower.height_m = 20.0, tower.ei_nm2 = 4.0e7, tower.mass_per_m_kg = 120.0;
  tower.diameter_ratio = 0.6, tower.parts = 4, tower.tip_mass_kg = 300.0;
  const auto in_series = make_tower(tower, {});
  tower.shear_n = 5.0e6;
  const auto declared = make_tower(tower, {});
  EXPECT_EQ(index_of(*declared, "shear_flexibility"), -1);
  expect_equal(hz_with(*in_series, "shear_flexibility", 1.0 / *tower.shear_n),
               hz_of(*declared, declared_values(*declared)), 1e-5, "tower");
  EXPECT_LT(hz_of(*declared, declared_values(*declared))(0), 0.99 * hz_of(*in_series, declared_values(*in_series))(0));
}

// A clamped bar with a rigid end is a shorter clamped bar.
TEST(RigidOffset, ShortensAClampedBar) {
  const auto model = make_beam(unit_beam(4, true), {});
  const VectorXd whole = hz_of(*model, declared_values(*model));
  for (const double length : {0.01, 0.05, 0.1, 0.124}) {
    for (const char* end : {"rigid_end_1_first", "rigid_end_1_last"})
      expect_equal(hz_with(*model, end, length), whole / ((1.0 - length) * (1.0 - length)), 1e-6, end);
  }
}

Frame2d portal(double length = 1.0) {
  Frame2d out;
  const Connection fixed = Connection::rigid();
  out.nodes = {{"a", 0, 0, 0, fixed, fixed, fixed},
               {"b", 0, 4 * length, 50, {}, {}, {}},
               {"c", 5 * length, 4 * length, 0, {}, {}, {}},
               {"d", 5 * length, 0, 0, fixed, fixed, {}}};
  out.members = {{"left", "a", "b", 2e6, 4e8, 90, {}, -1e4, "columns"},
                 {"beam", "b", "c", 3e6, 5e8, 150, {}, 0.0, ""},
                 {"right", "c", "d", 2e6, 4e8, 90, 5e7, 0.0, "columns"}};
  return out;
}

// Against the member divided at the joint's face, its first piece 1e4 times as stiff.
TEST(RigidOffset, IsAStiffPieceOfTheMember) {
  const double face = 0.6;
  const auto model = make_frame2d(portal(), {});
  Frame2d divided = portal();
  divided.nodes.push_back({"face", face, 4, 0, {}, {}, {}});
  divided.members[1] = {"joint", "b", "face", 3e10, 5e12, 150, {}, 0.0, ""};
  divided.members.push_back({"rest", "face", "c", 3e6, 5e8, 150, {}, 0.0, ""});
  const auto against = make_frame2d(divided, {});
  expect_equal(hz_with(*model, "rigid_end_beam_b", face), hz_of(*against, declared_values(*against)), 1e-4, "portal");
}

std::vector<std::pair<std::string, std::unique_ptr<StructuralModel>>> scaled(double s) {
  std::vector<std::pair<std::string, std::unique_ptr<StructuralModel>>> out;
  Tower tower;
  tower.height_m = 20.0 * s, tower.ei_nm2 = 4.0e7, tower.mass_per_m_kg = 1200.0, tower.diameter_ratio = 0.7;
  tower.parts = 3, tower.tip_mass_kg = 300.0, tower.guys = {{13.0 * s, 2.0e4}};
  tower.foot_rotation = Connection::spring(9.0e6);
  out.emplace_back("tower", make_tower(tower, {}));
  tower.shear_n = 3e6, tower.rotary_per_m_kgm = 80.0;
  out.emplace_back("tower that shears", make_tower(tower, {}));
  Beam beam;
  beam.spans = {{9.0 * s, 3.0e7, 200.0, 3}, {11.0 * s, 3.0e7, 200.0, 2}};
  beam.supports.resize(3);
  beam.supports[1].displacement = Connection::spring(4.0e6);
  beam.axial_n = -2e5, beam.masses = {{3.0 * s, 150.0}};
  out.emplace_back("beam", make_beam(beam, {}));
  Cable cable;
  cable.length_m = 90 * s, cable.mass_per_m_kg = 50, cable.tension_n = 1.5e6, cable.ei_nm2 = 2e5;
  out.emplace_back("cable", make_cable(cable, {}));
  out.emplace_back("frame2d", make_frame2d(portal(s), {}));
  return out;
}

TEST(LengthScale, IsTheStructureBuiltToTheOtherScale) {
  for (const double s : {0.8, 1.15}) {
    const auto declared = scaled(1.0), built = scaled(s);
    for (std::size_t i = 0; i < declared.size(); ++i) {
      const StructuralModel& model = *built[i].second;
      expect_equal(hz_with(*declared[i].second, "length", s), hz_of(model, declared_values(model)), 1e-7,
                   declared[i].first);
    }
  }
}

// Two masts of one frequency: coupled at their tips they move together as before, and against each other faster.
TEST(Coupling, MovesEqualMastsAgainstEachOtherOnly) {
  Frame2d masts;
  const Connection fixed = Connection::rigid();
  for (const std::string side : {"a", "b"}) {
    const double x = side == "a" ? 0.0 : 3.0;
    masts.nodes.push_back({side + "0", x, 0, 0, fixed, fixed, fixed});
    masts.nodes.push_back({side + "1", x, 5, 0, {}, {}, {}});
    masts.members.push_back({side, side + "0", side + "1", 1e6, 1e10, 100, {}, 0.0, ""});
  }
  masts.couplings = {{"a1", "b1", 0.0}};
  const auto model = make_frame2d(masts, {});
  const VectorXd apart = hz_of(*model, declared_values(*model), 2);
  EXPECT_NEAR(apart(0) / apart(1), 1.0, 1e-6);
  const VectorXd coupled = hz_with(*model, "coupling_a1-b1", 3e3, 2);
  EXPECT_NEAR(coupled(0) / apart(0), 1.0, 1e-6);
  // Rayleigh's quotient with the cantilever's modal mass, a quarter of the whole at the tip: 2 k for the pair.
  const double lambda = std::pow(2.0 * kPi * apart(0), 2) + 2.0 * 3e3 / (0.25 * 500.0);
  EXPECT_NEAR(coupled(1) / (std::sqrt(lambda) / (2.0 * kPi)), 1.0, 5e-3);
  masts.couplings = {{"a1", "a1", 0.0}};
  EXPECT_THROW((void)make_frame2d(masts, {}), std::invalid_argument);
}

// The modes of a declared model with one parameter changed, exact.
std::vector<ReferenceMode> modes_with(const DeclaredFrame& declared, const VectorXd& values) {
  const auto modes = declared.model->modes(values, 5, {});
  std::vector<ReferenceMode> out;
  for (Index r = 0; r < modes->frequency_hz.size(); ++r) {
    ReferenceMode mode;
    mode.number = static_cast<int>(r) + 1;
    mode.frequency_hz = modes->frequency_hz(r), mode.sigma_hz = 1e-3 * mode.frequency_hz;
    for (Index i = 0; i < modes->shapes.rows(); ++i) {
      mode.shape.push_back(modes->shapes(i, r) / modes->shapes.col(r).cwiseAbs().maxCoeff());
      mode.shape_sigma.push_back(0.01);
    }
    out.push_back(std::move(mode));
  }
  return out;
}

DeclaredFrame sprung_beam() {
  Beam beam = unit_beam(5, false);
  beam.supports[0].rotation = Connection::rigid();
  beam.supports[1].displacement = Connection::spring(80.0);
  std::vector<Sight> sights;
  for (int i = 0; i < 6; ++i)
    sights.push_back({"r" + std::to_string(i), {0.1 + 0.16 * i, 0, 0}, Eigen::Vector3d::UnitZ()});
  DeclaredFrame out = declare(make_beam(beam, std::move(sights)), 6);
  out.stiffness_over_mass_per_s2 = 1.0;
  out.temperature = TemperatureLaw{-1e-3, -0.2};
  return out;
}

TEST(PlacedEffects, ShearRigidEndAndLengthAreFoundWithTheirSizes) {
  const DeclaredFrame declared = sprung_beam();
  const struct {
    const char *effect, *parameter;
    double value, size;
  } cases[] = {{"shear_flexibility", "shear_flexibility", 0.004, 0.4},
               {"rigid_offset", "rigid_end_1_first", 0.04, 2.0},
               {"length_scale", "length", 1.06, 1.06}};
  for (const auto& one : cases) {
    VectorXd values = declared_values(*declared.model);
    values(index_of(*declared.model, one.parameter)) = one.value;
    const FrameModel model{&declared, {&structural(one.effect)}};
    const FrameFit fit = fit_frame(model, modes_with(declared, values), {}, Starts::kAll);
    ASSERT_TRUE(fit.ok) << one.effect;
    EXPECT_LT(fit.chi2, 1e-4) << one.effect;
    EXPECT_NEAR(fit.parameters(fit.parameters.size() - 1) / one.size, 1.0, 1e-3) << one.effect;
  }
}

TEST(Temperature, ChangesPartsAndForcesByTheDeclaredCoefficients) {
  const DeclaredFrame declared = sprung_beam();
  VectorXd values = declared_values(*declared.model);
  const double kelvin[] = {12.0};
  structural("temperature").apply(kelvin, declared, values);
  EXPECT_NEAR(values(index_of(*declared.model, "stiffness_3")), 1.0 - 12e-3, 1e-12);
  EXPECT_NEAR(values(index_of(*declared.model, "axial_force")), -2.4, 1e-12);
  EXPECT_NEAR(values(index_of(*declared.model, "support_2_displacement_stiffness")), 80.0, 1e-12);
  const FrameModel model{&declared, {&structural("temperature")}};
  const FrameFit fit = fit_frame(model, modes_with(declared, values), {}, Starts::kAll);
  ASSERT_TRUE(fit.ok);
  EXPECT_NEAR(fit.parameters(0), 12.0, 1e-2);
  EXPECT_THAT(structural("temperature").meaning(kelvin, declared), HasSubstr("stiffness -1.2 %, axial force -2.4 N"));
}

TEST(Obstacles, SayWhatWouldMakeAnEffectObservable) {
  const auto words = [](const char* effect, const DeclaredFrame& declared) {
    const auto found = structural(effect).obstacle(declared);
    return found ? found->reason + "; " + found->instead : "none";
  };
  DeclaredFrame declared = sprung_beam();
  EXPECT_EQ(words("temperature", declared), "none");
  EXPECT_EQ(words("length_scale", declared), "none");
  EXPECT_THAT(words("coupling", declared), HasSubstr("declare both structures in one frame2d"));
  declared.stiffness_over_mass_per_s2.reset();
  EXPECT_THAT(words("length_scale", declared), HasSubstr("declare stiffness: known"));
  EXPECT_EQ(words("temperature", declared), "none") << "the axial force changes with it";
  declared.temperature->axial_n_per_k = 0.0;
  EXPECT_THAT(words("temperature", declared), HasSubstr("a common factor of all frequencies"));
  declared.temperature.reset();
  EXPECT_THAT(words("temperature", declared), HasSubstr("is not declared"));
  Beam sheared = unit_beam(2, false);
  sheared.shear_n = 1e3;
  EXPECT_THAT(words("shear_flexibility", declare(make_beam(sheared, {}), 4)), HasSubstr("leave shear_n out"));
  DeclaredFrame storeys;
  storeys.n_storeys = 4;
  EXPECT_THAT(words("length_scale", storeys), HasSubstr("stiffness_scale"));
}

}  // namespace
}  // namespace core::structure
