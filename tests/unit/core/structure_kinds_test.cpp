#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>

#include "core/structure/kinds/beam.h"
#include "core/structure/kinds/cable.h"
#include "core/structure/kinds/frame2d.h"
#include "core/structure/kinds/matrices.h"
#include "core/structure/kinds/modes.h"
#include "core/structure/kinds/shear_storeys.h"
#include "core/structure/kinds/tower.h"

namespace core::structure {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

Tower tower() {
  Tower out;
  out.height_m = 20.0, out.ei_nm2 = 4.0e7, out.mass_per_m_kg = 120.0;
  out.diameter_ratio = 0.7, out.parts = 4, out.tip_mass_kg = 300.0;
  out.guys = {{13.0, 2.0e4}};
  return out;
}

Beam beam() {
  Beam out;
  out.spans = {{9.0, 3.0e7, 200.0, 3}, {11.0, 3.0e7, 200.0, 2}};
  out.supports.resize(3);
  out.supports[0].rotation = Connection::rigid();
  out.supports[1].displacement = Connection::spring(4.0e6);
  return out;
}

Frame2d portal() {
  Frame2d out;
  const Connection fixed = Connection::rigid();
  out.nodes = {{"a", 0, 0, 0, fixed, fixed, fixed},
               {"b", 0, 4, 50, {}, {}, {}},
               {"c", 5, 4, 0, {}, {}, {}},
               {"d", 5, 0, 0, fixed, fixed, {}}};
  out.members = {{"left", "a", "b", 2e6, 4e8, 90, {}, -1e4, "columns"},
                 {"beam", "b", "c", 3e6, 5e8, 150, {}, 0.0, ""},
                 {"right", "c", "d", 2e6, 4e8, 90, 5e7, 0.0, "columns"}};
  return out;
}

std::unique_ptr<StructuralModel> model_of(const std::string& kind) {
  if (kind == "tower") return make_tower(tower(), {{"top", {0, 0, 20}, {1, 0, 0}}, {"middle", {0, 0, 9}, {1, 0, 0}}});
  if (kind == "beam") return make_beam(beam(), {{"one", {4, 0, 0}, {0, 0, 1}}, {"two", {15, 0, 0}, {0, 0, 1}}});
  if (kind == "cable") {
    Cable cable;
    cable.length_m = 90, cable.mass_per_m_kg = 50, cable.tension_n = 1.5e6, cable.ei_nm2 = 2e5, cable.ea_n = 8e8;
    return make_cable(cable, {{"quarter", {22, 0, 0}, {0, 0, 1}}, {"third", {30, 0, 0}, {0, 0, 1}}});
  }
  if (kind == "frame2d") return make_frame2d(portal(), {{"b", {0, 0, 4}, {1, 0, 0}}, {"mid", {2.5, 0, 4}, {0, 0, 1}}});
  ShearFrame frame;
  frame.mass.assign(5, 2.0), frame.stiffness_per_s2.assign(5, 900.0), frame.joint_flexibility = 0.05;
  return make_shear_storeys(frame, {{"roof", {0, 0, 5}, {1, 0, 0}}, {"first", {0, 0, 1}, {1, 0, 0}}});
}

class EveryKind : public testing::TestWithParam<const char*> {};

// Values away from the declared ones, so that no parameter is at a bound.
VectorXd away(const StructuralModel& model) {
  VectorXd values = declared_values(model);
  for (std::size_t i = 0; i < model.parameters().size(); ++i)
    values(static_cast<Index>(i)) += 0.3 * model.parameters()[i].scale;
  return values;
}

TEST_P(EveryKind, DerivativesAreTheDifferencesOfModes) {
  const auto model = model_of(GetParam());
  const VectorXd values = away(*model);
  std::vector<std::size_t> all(model->parameters().size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  const auto modes = model->modes(values, 4, all);
  ASSERT_TRUE(modes);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double step = 1e-4 * model->parameters()[i].scale;
    VectorXd up = values, down = values;
    up(static_cast<Index>(i)) += step, down(static_cast<Index>(i)) -= step;
    const auto high = model->modes(up, 4, {}), low = model->modes(down, 4, {});
    ASSERT_TRUE(high && low);
    for (Index r = 0; r < 4; ++r) {
      const double scale = modes->frequency_hz(r) / model->parameters()[i].scale;
      EXPECT_NEAR(modes->d_frequency_hz(r, static_cast<Index>(i)),
                  (high->frequency_hz(r) - low->frequency_hz(r)) / (2.0 * step), 1e-6 * scale)
          << model->parameters()[i].name << ", mode " << r + 1;
      const auto aligned = [&](const ModelModes& m) {
        return VectorXd((m.shapes.col(r).dot(modes->shapes.col(r)) < 0.0 ? -1.0 : 1.0) * m.shapes.col(r));
      };
      const VectorXd slope = (aligned(*high) - aligned(*low)) / (2.0 * step);
      EXPECT_LT((modes->d_shapes[i].col(r) - slope).norm() * model->parameters()[i].scale,
                1e-5 * modes->shapes.col(r).norm() + 1e-7)
          << model->parameters()[i].name << ", mode " << r + 1;
    }
  }
}

TEST_P(EveryKind, StiffeningRaisesAndMassLowersEveryFrequency) {
  const auto model = model_of(GetParam());
  const VectorXd values = declared_values(*model);
  const auto before = model->modes(values, 4, {});
  ASSERT_TRUE(before);
  for (std::size_t i = 0; i < model->parameters().size(); ++i) {
    const ModelParameter& p = model->parameters()[i];
    if (p.role != Role::kPartStiffness && p.role != Role::kAddedMass && p.role != Role::kSpring) continue;
    VectorXd changed = values;
    changed(static_cast<Index>(i)) += p.scale;
    const auto after = model->modes(changed, 4, {});
    ASSERT_TRUE(after);
    const double sign = p.role == Role::kAddedMass ? -1.0 : 1.0;
    for (Index r = 0; r < 4; ++r)
      EXPECT_GE(sign * (after->frequency_hz(r) / before->frequency_hz(r) - 1.0), -1e-9) << p.name;
    EXPECT_GT((after->frequency_hz - before->frequency_hz).cwiseAbs().maxCoeff(), 0.0) << p.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Structure, EveryKind, testing::Values("shear_frame", "tower", "beam", "cable", "frame2d"));

std::string refusal(const std::function<void()>& make) {
  try {
    make();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(StructureKinds, ABucklingTowerHasNoModes) {
  Tower heavy = tower();
  heavy.guys.clear();
  heavy.tip_mass_kg = 1e7;
  const auto model = make_tower(heavy, {});
  EXPECT_FALSE(model->modes(declared_values(*model), 3, {}));
}

TEST(StructureKinds, TheCamerasDirectionIsProjected) {
  const double half = std::sqrt(0.5);
  const auto model = make_tower(
      tower(),
      {{"face", {0, 0, 20}, {1, 0, 0}}, {"slanted", {0, 0, 20}, {half, half, 0}}, {"across", {0, 0, 20}, {0, 1, 0}}});
  const auto modes = model->modes(declared_values(*model), 2, {});
  ASSERT_TRUE(modes);
  EXPECT_NEAR(modes->shapes(1, 0), half * modes->shapes(0, 0), 1e-12);
  EXPECT_NEAR(modes->shapes(2, 0), 0.0, 1e-12);
}

TEST(StructureKinds, APlaceFarFromTheStructureIsRefusedWithItsUnit) {
  EXPECT_NE(refusal([] {
              (void)make_tower(tower(), {{"roof", {0, 0, 20000}, {1, 0, 0}}});
            }).find("unit (m)"),
            std::string::npos);
}

// Two masses on springs, and a group.
MatrixStructure two_masses() {
  MatrixStructure out;
  Eigen::MatrixXd k(2, 2), m(2, 2), g(2, 2);
  k << 300, -100, -100, 100;
  g << 100, -100, -100, 100;
  m << 2, 0, 0, 1;
  out.stiffness = k.sparseView(), out.mass = m.sparseView();
  out.groups.push_back({"top", g.sparseView(), {}, 0.0});
  out.seen = {{"one", {{0, 1.0}}}, {"two", {{1, 1.0}}}};
  out.n_modes = 2;
  return out;
}

TEST(MatricesKind, AgreesWithTheHandCalculation) {
  const auto model = make_matrices(two_masses());
  const auto modes = model->modes(declared_values(*model), 2, {});
  ASSERT_TRUE(modes);
  ASSERT_EQ(modes->frequency_hz.size(), 2);
  // lambda of 2 x^2 - 500 x + 20000 = 0
  EXPECT_NEAR(modes->frequency_hz(0), std::sqrt(50.0) / (2.0 * std::numbers::pi), 1e-9);
  EXPECT_NEAR(modes->frequency_hz(1), std::sqrt(200.0) / (2.0 * std::numbers::pi), 1e-9);
  EXPECT_NEAR(modes->shapes(1, 0) / modes->shapes(0, 0), 2.0, 1e-9);
}

TEST(MatricesKind, MasslessDegreesOfFreedomAreAllowed) {
  MatrixStructure s = two_masses();
  s.mass.coeffRef(0, 0) = 0.0;
  const auto model = make_matrices(s);
  const auto modes = model->modes(declared_values(*model), 2, {});
  ASSERT_TRUE(modes);
  ASSERT_EQ(modes->frequency_hz.size(), 1);
  EXPECT_NEAR(modes->frequency_hz(0), std::sqrt(100.0 - 100.0 * 100.0 / 300.0) / (2.0 * std::numbers::pi), 1e-9);
}

TEST(MatricesKind, EqualFrequenciesAreBothFound) {
  MatrixStructure s;
  const Index n = 30;
  Eigen::MatrixXd k = 100.0 * Eigen::MatrixXd::Identity(n, n);
  for (Index i = 4; i < n; ++i) k(i, i) = 1000.0 + 10.0 * static_cast<double>(i);
  s.stiffness = k.sparseView(), s.mass = Eigen::MatrixXd::Identity(n, n).sparseView();
  const auto modes = exact_modes(s, {}, 5);
  ASSERT_EQ(modes.frequency_hz.size(), 5);
  for (Index r = 0; r < 4; ++r) EXPECT_NEAR(modes.frequency_hz(r), 10.0 / (2.0 * std::numbers::pi), 1e-9);
  EXPECT_GT(modes.frequency_hz(4), 3.0 * modes.frequency_hz(0));
}

// Stiff string with held ends, of L sqrt(T / EI) = xi: f_n / f_n0 = 1 + 2 / xi + (4 + n^2 pi^2 / 2) / xi^2 (Morse,
// Vibration and Sound, 16). The boundary layer of bending is L / xi.
TEST(CableKind, ResolvesTheBoundaryLayerOfHeldEnds) {
  for (const double xi : {300.0, 600.0}) {
    Cable cable;
    cable.length_m = 150.0, cable.mass_per_m_kg = 60.0, cable.tension_n = 4.0e6;
    cable.ei_nm2 = cable.tension_n * cable.length_m * cable.length_m / (xi * xi);
    cable.end_rotation = Connection::rigid();
    const auto model = make_cable(cable, {});
    const auto modes = model->modes(declared_values(*model), 5, {});
    ASSERT_TRUE(modes);
    for (Index n = 1; n <= 5; ++n) {
      const auto order = static_cast<double>(n);
      const double plain = order / (2.0 * cable.length_m) * std::sqrt(cable.tension_n / cable.mass_per_m_kg);
      const double bent =
          1.0 + 2.0 / xi + (4.0 + 0.5 * order * order * std::numbers::pi * std::numbers::pi) / (xi * xi);
      EXPECT_NEAR(modes->frequency_hz(n - 1) / (plain * bent), 1.0, 2e-5) << xi << ' ' << n;
    }
  }
}

TEST(MatricesKind, HostileMatricesAreRefusedInWords) {
  const auto words = [](const std::function<void(MatrixStructure&)>& spoil) {
    MatrixStructure s = two_masses();
    spoil(s);
    return refusal([&] { (void)make_matrices(s); });
  };
  EXPECT_NE(words([](auto& s) { s.stiffness.coeffRef(0, 1) = 7.0; }).find("not symmetric"), std::string::npos);
  EXPECT_NE(words([](auto& s) { s.mass = SparseMatrix(3, 3); }).find("same degrees of freedom"), std::string::npos);
  EXPECT_NE(words([](auto& s) { s.seen[0].dofs[0].first = 9; }).find("there are 2"), std::string::npos);
  EXPECT_NE(words([](auto& s) { s.stiffness.coeffRef(1, 1) = 0.0; }).find("positive diagonal"), std::string::npos);
  EXPECT_NE(words([](auto& s) { s.stiffness.coeffRef(1, 1) = 10.0; }).find("neither positive definite"),
            std::string::npos);
  EXPECT_NE(words([](auto& s) { s.stiffness *= 1e18; }).find("units"), std::string::npos);
  EXPECT_NE(words([](auto& s) { s.mass.coeffRef(0, 0) = std::nan(""); }).find("is no number"), std::string::npos);
}

TEST(ModesKind, FollowsItsSensitivities) {
  ModeTable table;
  table.channels = {"a"}, table.parameters = {"deck", "pier"};
  table.modes = {{1.0, {1.0}, {0.4, 0.1}}, {2.5, {-0.5}, {0.2, 0.3}}};
  const auto model = make_modes(table);
  VectorXd values(2);
  values << 0.9, 1.2;
  const auto modes = model->modes(values, 2, {1});
  ASSERT_TRUE(modes);
  EXPECT_NEAR(modes->frequency_hz(0), 1.0 * (1.0 - 0.04 + 0.02), 1e-12);
  EXPECT_NEAR(modes->d_frequency_hz(1, 0), 0.75, 1e-12);
  table.modes[1].sensitivity.pop_back();
  EXPECT_NE(refusal([&] { (void)make_modes(table); }).find("2 parameters"), std::string::npos);
}

}  // namespace
}  // namespace core::structure
