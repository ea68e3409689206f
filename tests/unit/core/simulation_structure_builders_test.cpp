#include "core/simulation/structure/structure_builders.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "core/simulation/structure/structure_model.h"

namespace core::simulation {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
const Damping kOnePercent = ModalDamping{{0.01}};

ShearBuilding uniform_frame(int n) {
  ShearBuilding frame;
  frame.mass_kg.assign(static_cast<std::size_t>(n), 8.0);
  frame.stiffness_n_per_m.assign(static_cast<std::size_t>(n), 2.0e4);
  return frame;
}

// w_r = 2 sqrt(k / m) sin((2 r - 1) pi / (4 n + 2)).
TEST(ShearBuilding, HasTheFrequenciesAndShapesOfTheUniformChain) {
  for (const int n : {1, 2, 6, 20}) {
    const std::vector<TrueMode> modes = modes_of(shear_frame(uniform_frame(n), kOnePercent));
    ASSERT_EQ(modes.size(), static_cast<std::size_t>(n));
    const Eigen::MatrixXd shapes = shear_chain_shapes(n);
    for (int r = 1; r <= n; ++r) {
      const TrueMode& mode = modes[static_cast<std::size_t>(r) - 1];
      const double exact =
          2.0 * std::sqrt(2.0e4 / 8.0) * std::sin((2 * r - 1) * std::numbers::pi / (4 * n + 2)) / kTwoPi;
      EXPECT_NEAR(mode.frequency_hz / exact, 1.0, 1e-12);
      EXPECT_NEAR(mode.damping_ratio, 0.01, 1e-12);
      const Eigen::VectorXcd shape = shapes.col(r - 1).cast<std::complex<double>>();
      EXPECT_NEAR(std::norm(shape.dot(mode.displacement)) / (shape.squaredNorm() * mode.displacement.squaredNorm()),
                  1.0, 1e-12);
    }
  }
}

// Two storeys of mass m and 2 k, k: w^2 = k / m (2 -+ sqrt(2)).
TEST(ShearBuilding, SolvesTheTwoStoreyTextbookFrame) {
  const std::vector<TrueMode> modes = modes_of(shear_frame({{3.0, 3.0}, {2.0e3, 1.0e3}, 0.0, {}}, kOnePercent));
  EXPECT_NEAR(std::pow(kTwoPi * modes[0].frequency_hz, 2), 1.0e3 / 3.0 * (2.0 - std::numbers::sqrt2), 1e-8);
  EXPECT_NEAR(std::pow(kTwoPi * modes[1].frequency_hz, 2), 1.0e3 / 3.0 * (2.0 + std::numbers::sqrt2), 1e-8);
}

TEST(ShearBuilding, PutsTheGroundSpringInSeriesWithTheLowestStorey) {
  ShearBuilding frame{{2.0}, {3.0e3}, 1.5e3, {}};
  EXPECT_NEAR(modes_of(shear_frame(frame, kOnePercent))[0].frequency_hz, std::sqrt(1.0e3 / 2.0) / kTwoPi, 1e-12);
}

// One storey: an inverted pendulum on a spring, w^2 = k / m - g / h.
TEST(ShearBuilding, IsSoftenedByGravity) {
  ShearBuilding frame{{2.0}, {3.0e3}, 0.0, {120.0}};
  const double w2 = 3.0e3 / 2.0 - 9.80665 / 0.12;
  EXPECT_NEAR(modes_of(shear_frame(frame, kOnePercent))[0].frequency_hz, std::sqrt(w2) / kTwoPi, 1e-12);
  frame.storey_height_mm = {6.0};
  EXPECT_THROW((void)shear_frame(frame, kOnePercent), std::invalid_argument);
}

TEST(ShearBuilding, MovesAsOneWithTheGroundWhenItIsPushedSlowly) {
  const StructureModel model = shear_frame(uniform_frame(4), kOnePercent);
  EXPECT_TRUE(model.influence.isApprox(model.mass * Eigen::VectorXd::Ones(4)));
}

TEST(Damping, GivesEachModeItsRatioAndTheLastToTheRest) {
  const StructureModel model = shear_frame(uniform_frame(5), ModalDamping{{0.004, 0.02}});
  const std::vector<TrueMode> modes = modes_of(model);
  EXPECT_NEAR(modes[0].damping_ratio, 0.004, 1e-12);
  for (std::size_t r = 1; r < 5; ++r) EXPECT_NEAR(modes[r].damping_ratio, 0.02, 1e-12);
}

TEST(Damping, FollowsRayleighsCurve) {
  for (const TrueMode& mode : modes_of(shear_frame(uniform_frame(5), RayleighDamping{0.3, 1e-4}))) {
    const double w = kTwoPi * mode.frequency_hz;
    EXPECT_NEAR(mode.damping_ratio, 0.5 * (0.3 / w + 1e-4 * w), 1e-12);
  }
}

// c proportional to k is Rayleigh's beta = c / k; one dashpot alone is not proportional, and its shapes are complex:
// (K + s C + s^2 M) phi = 0.
TEST(Damping, TakesDashpots) {
  const StructureModel even = shear_frame(uniform_frame(4), Dashpots{{4.0, 4.0, 4.0, 4.0}});
  for (const TrueMode& mode : modes_of(even)) {
    EXPECT_NEAR(mode.damping_ratio, 0.5 * 4.0 / 2.0e4 * kTwoPi * mode.frequency_hz, 1e-12);
  }
  const StructureModel odd = shear_frame(uniform_frame(4), Dashpots{{0.0, 0.0, 0.0, 60.0}});
  double imaginary = 0.0;
  for (const TrueMode& mode : modes_of(odd)) {
    const double w = kTwoPi * mode.frequency_hz, zeta = mode.damping_ratio;
    const std::complex<double> s(-zeta * w, w * std::sqrt(1.0 - zeta * zeta));
    const Eigen::VectorXcd left = odd.stiffness * mode.displacement + s * (odd.damping * mode.displacement) +
                                  s * s * (odd.mass * mode.displacement);
    EXPECT_LT(left.norm(), 1e-9 * (odd.stiffness * mode.displacement).norm());
    imaginary = std::max(imaginary, mode.displacement.imag().cwiseAbs().maxCoeff());
  }
  EXPECT_GT(imaginary, 0.01);
}

TEST(FromModes, HasTheModesItIsGiven) {
  Eigen::MatrixXd shapes(3, 2), tilts(3, 2);
  shapes << 0.2, 0.7, 0.6, 1.0, 1.0, -0.8;
  tilts << 1e-4, 3e-4, 2e-4, 0.0, 2e-4, -5e-4;
  const std::vector<TrueMode> modes =
      modes_of(from_modes({1.3, 4.7}, {0.01, 0.03}, 5.0 * shapes, {2.0, 1.0, 4.0}, 5.0 * tilts));
  ASSERT_EQ(modes.size(), 2U);
  EXPECT_NEAR(modes[1].frequency_hz, 4.7, 1e-12);
  EXPECT_NEAR(modes[1].damping_ratio, 0.03, 1e-12);
  for (Eigen::Index r = 0; r < 2; ++r) {
    EXPECT_LT((modes[static_cast<std::size_t>(r)].displacement - shapes.col(r)).norm(), 1e-12);
    EXPECT_LT((modes[static_cast<std::size_t>(r)].tilt - tilts.col(r)).norm(), 1e-15);
  }
}

TEST(FromModes, IsTheUniformChainWithItsShapes) {
  const StructureModel a = uniform_chain({1.0, 3.0, 5.0}, {0.01, 0.01, 0.02});
  const StructureModel b = from_modes({1.0, 3.0, 5.0}, {0.01, 0.01, 0.02}, shear_chain_shapes(3), {1.0, 1.0, 1.0});
  const Eigen::VectorXcd at_a = a.displacement * response_at(a, 7.0, a.influence.cast<std::complex<double>>());
  const Eigen::VectorXcd at_b = b.displacement * response_at(b, 7.0, b.influence.cast<std::complex<double>>());
  EXPECT_LT((at_a - at_b).norm(), 1e-12 * at_a.norm());
}

TEST(FromMatrices, IsTheShearFrameOfTheSameMatrices) {
  const StructureModel frame = shear_frame(uniform_frame(3), Dashpots{{5.0, 0.0, 2.0}});
  const StructureModel model = from_matrices(frame.mass, frame.damping, frame.stiffness);
  EXPECT_TRUE(model.influence.isApprox(frame.influence));
  EXPECT_TRUE(model.displacement.isApprox(frame.displacement));
}

TEST(StructureBuilders, RefuseWhatIsNoStructure) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(2, 2), none;
  Eigen::MatrixXd lopsided = one;
  lopsided(0, 1) = 0.3;
  const std::vector<std::function<void()>> faults{
      [] { (void)shear_frame({}, kOnePercent); },
      [] {
        (void)shear_frame({{1.0, 2.0}, {1e3}, 0.0, {}}, kOnePercent);
      },
      [] {
        (void)shear_frame({{1.0, -2.0}, {1e3, 1e3}, 0.0, {}}, kOnePercent);
      },
      [] {
        (void)shear_frame({{1.0, 2.0}, {1e3, 0.0}, 0.0, {}}, kOnePercent);
      },
      [] {
        (void)shear_frame({{1.0}, {1e3}, -1.0, {}}, kOnePercent);
      },
      [] {
        (void)shear_frame({{1.0}, {1e3}, 0.0, {100.0, 100.0}}, kOnePercent);
      },
      [&] {
        (void)shear_frame({{nan}, {1e3}, 0.0, {}}, kOnePercent);
      },
      [] { (void)shear_frame(uniform_frame(3), ModalDamping{}); },
      [] { (void)shear_frame(uniform_frame(3), ModalDamping{{-0.01}}); },
      [] {
        (void)shear_frame(uniform_frame(3), ModalDamping{{0.01, 1.2}});
      },
      [] {
        (void)shear_frame(uniform_frame(3), RayleighDamping{-0.1, 0.0});
      },
      [] {
        (void)shear_frame(uniform_frame(3), RayleighDamping{0.0, 0.0});
      },
      [] {
        (void)shear_frame(uniform_frame(3), Dashpots{{1.0, 1.0}});
      },
      [] {
        (void)shear_frame(uniform_frame(3), Dashpots{{0.0, 0.0, 0.0}});
      },
      [] { (void)shear_frame(uniform_frame(65), kOnePercent); },
      [&] {
        (void)from_modes({1.0}, {0.01}, one, {1.0, 1.0});
      },
      [&] {
        (void)from_modes({1.0, -2.0}, {0.01, 0.01}, one, {1.0, 1.0});
      },
      [&] {
        (void)from_modes({1.0, 2.0}, {0.01, 0.0}, one, {1.0, 1.0});
      },
      [&] {
        (void)from_modes({1.0, 2.0}, {0.01, 0.01}, one, {1.0, 0.0});
      },
      [&] {
        (void)from_modes({1.0, 2.0}, {0.01, 0.01}, 0.0 * one, {1.0, 1.0});
      },
      [&] {
        (void)from_modes({1.0, 2.0}, {0.01, 0.01}, one, {1.0, 1.0}, Eigen::MatrixXd::Zero(1, 2));
      },
      [&] { (void)from_matrices(one, -0.01 * one, one); },
      [&] { (void)from_matrices(one, 0.0 * one, one); },
      [&] { (void)from_matrices(one, 0.01 * one, -one); },
      [&] { (void)from_matrices(-one, 0.01 * one, one); },
      [&] { (void)from_matrices(one, 0.01 * one, lopsided); },
      [&] { (void)from_matrices(one, none, one); },
      [&] { (void)from_matrices(none, none, none); }};
  for (std::size_t i = 0; i < faults.size(); ++i) EXPECT_THROW(faults[i](), std::invalid_argument) << "fault " << i;
}

}  // namespace
}  // namespace core::simulation
