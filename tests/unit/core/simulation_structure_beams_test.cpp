#include "core/simulation/structure/beam_builders.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "core/simulation/structure/structure_model.h"

namespace core::simulation {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kStiffness = 3.0e8, kMass = 160.0, kLength_m = 30.0;
const Damping kOnePercent = ModalDamping{{0.01}};

Cantilever tower(int bodies) { return {1e3 * kLength_m, bodies, kStiffness, kMass, 0.0}; }
BridgeDeck deck(int bodies, int n_spans = 1) {
  return {1e3 * kLength_m, bodies, n_spans, kStiffness, kMass, BridgeDeck::Ends::kSimple};
}

double beam_hz(double lambda) {
  return lambda * lambda / (kTwoPi * kLength_m * kLength_m) * std::sqrt(kStiffness / kMass);
}

TEST(Cantilever, HasTheFrequenciesOfTheClampedFreeBeam) {
  for (const int bodies : {1, 5, 8, 24, 60}) {
    const std::vector<TrueMode> modes = modes_of(cantilever(tower(bodies), kOnePercent));
    const double lambda[] = {1.87510407, 4.69409113, 7.85475744, 10.99554073, 14.13716839};
    for (std::size_t r = 0; r < 5; ++r) {
      EXPECT_NEAR(modes[r].frequency_hz / beam_hz(lambda[r]), 1.0, 1e-4) << bodies << " bodies, mode " << r + 1;
      EXPECT_NEAR(modes[r].damping_ratio, 0.01, 1e-9);
    }
  }
}

// cosh x - cos x - s (sinh x - sin x), and its slope, with x = lambda h / L.
TEST(Cantilever, LeansByTheSlopeOfItsShapeTowardsTheRightWhenItMovesRight) {
  const std::vector<TrueMode> modes = modes_of(cantilever(tower(6), kOnePercent));
  const double lambda[] = {1.87510407, 4.69409113};
  for (std::size_t r = 0; r < 2; ++r) {
    const double l = lambda[r], s = (std::cosh(l) + std::cos(l)) / (std::sinh(l) + std::sin(l));
    const auto shape = [&](double x) { return std::cosh(x) - std::cos(x) - s * (std::sinh(x) - std::sin(x)); };
    const auto slope = [&](double x) { return std::sinh(x) + std::sin(x) - s * (std::cosh(x) - std::cos(x)); };
    for (Eigen::Index i = 0; i < 6; ++i) {
      const double x = l * (static_cast<double>(i) + 1.0) / 6.0;
      EXPECT_NEAR(modes[r].displacement(i).real(), shape(x) / shape(l), 1e-5);
      EXPECT_NEAR(modes[r].tilt(i).real(), slope(x) / shape(l) * l / (1e3 * kLength_m), 1e-9);
    }
  }
  EXPECT_GT(modes[0].tilt(5).real(), 0.0);
}

// A heavy head on a light mast: 3 EI / (L^3 (M + 33/140 m L)) (Rayleigh's quotient with the static shape).
TEST(Cantilever, CarriesItsTipMass) {
  Cantilever mast = tower(4);
  mast.tip_mass_kg = 2.0e5;
  const double w = std::sqrt(3.0 * kStiffness / std::pow(kLength_m, 3) / (2.0e5 + 33.0 / 140.0 * kMass * kLength_m));
  EXPECT_NEAR(modes_of(cantilever(mast, kOnePercent))[0].frequency_hz * kTwoPi / w, 1.0, 1e-5);
}

// All of a shaken beam's mass, less what its foot carries, is moved by the ground: in the first mode the effective mass
// is 61.3 % of the beam's (Clough & Penzien; integral of the shape squared over that of its square).
TEST(Cantilever, IsMovedByTheGround) {
  const StructureModel model = cantilever(tower(6), kOnePercent);
  const double w = kTwoPi * modes_of(model)[0].frequency_hz;
  // At resonance q = i phi (phi^T L) / (2 zeta w^2) with phi^T M phi = 1: the force at the foot shows phi^T L.
  const Eigen::VectorXcd q = response_at(model, w, -model.influence.cast<std::complex<double>>());
  const double effective = 2.0 * 0.01 * w * w * std::abs(model.influence.cast<std::complex<double>>().dot(q));
  EXPECT_NEAR(effective / (kMass * kLength_m), 0.613, 0.004);
}

TEST(BridgeDeck, HasTheFrequenciesOfTheSimplySupportedBeam) {
  for (const int bodies : {1, 3, 7}) {
    const StructureModel model = bridge_deck(deck(bodies), kOnePercent);
    EXPECT_EQ(model.axis, StructureModel::Axis::kY);
    const std::vector<TrueMode> modes = modes_of(model);
    std::size_t m = 0;
    for (int r = 1; r <= 5; ++r) {
      if (r % (bodies + 1) == 0) continue;  // every body is a node of this mode, which nobody sees
      EXPECT_NEAR(modes[m++].frequency_hz / beam_hz(r * std::numbers::pi), 1.0, 2e-4)
          << bodies << " bodies, mode " << r;
    }
  }
}

TEST(BridgeDeck, HasTheFrequenciesOfTheClampedBeam) {
  BridgeDeck clamped = deck(7);
  clamped.ends = BridgeDeck::Ends::kClamped;
  const std::vector<TrueMode> modes = modes_of(bridge_deck(clamped, kOnePercent));
  const double lambda[] = {4.73004074, 7.85320462, 10.9956079};
  for (std::size_t r = 0; r < 3; ++r) EXPECT_NEAR(modes[r].frequency_hz / beam_hz(lambda[r]), 1.0, 1e-4);
}

// Two spans: the spans in turn (as one simple span), then together (as one clamped at the pier: 3.92660231).
TEST(BridgeDeck, RunsThroughOverItsPiers) {
  const std::vector<TrueMode> modes = modes_of(bridge_deck(deck(5, 2), kOnePercent));
  EXPECT_NEAR(modes[0].frequency_hz / beam_hz(std::numbers::pi), 1.0, 1e-4);
  EXPECT_NEAR(modes[1].frequency_hz / beam_hz(3.92660231), 1.0, 1e-4);
  ASSERT_EQ(modes[0].displacement.size(), 10);
  EXPECT_NEAR((modes[0].displacement(2) + modes[0].displacement(7)).real(), 0.0, 1e-9);
}

TEST(BridgeDeck, BendsAsASineAndTiltsByItsSlope) {
  const TrueMode mode = modes_of(bridge_deck(deck(7), kOnePercent))[0];
  const std::vector<double> x_mm = body_positions_mm(deck(7));
  for (std::size_t i = 0; i < 7; ++i) {
    const double x = std::numbers::pi * x_mm[i] / (1e3 * kLength_m);
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(mode.displacement(row).real(), std::sin(x), 1e-6);
    EXPECT_NEAR(mode.tilt(row).real(), std::numbers::pi / (1e3 * kLength_m) * std::cos(x), 1e-10);
  }
}

TEST(Beams, RefuseWhatIsNoBeam) {
  const auto bad_tower = [](auto change) {
    return [change] {
      Cantilever t = tower(6);
      change(t);
      (void)cantilever(t, kOnePercent);
    };
  };
  const auto bad_deck = [](auto change) {
    return [change] {
      BridgeDeck d = deck(6);
      change(d);
      (void)bridge_deck(d, kOnePercent);
    };
  };
  const std::vector<std::function<void()>> faults{bad_tower([](Cantilever& t) { t.height_mm = 0.0; }),
                                                  bad_tower([](Cantilever& t) { t.bodies = 0; }),
                                                  bad_tower([](Cantilever& t) { t.bodies = 61; }),
                                                  bad_tower([](Cantilever& t) { t.bending_stiffness_n_m2 = -1.0; }),
                                                  bad_tower([](Cantilever& t) { t.mass_kg_per_m = std::nan(""); }),
                                                  bad_tower([](Cantilever& t) { t.tip_mass_kg = -1.0; }),
                                                  bad_deck([](BridgeDeck& d) { d.span_mm = HUGE_VAL; }),
                                                  bad_deck([](BridgeDeck& d) { d.n_spans = 0; }),
                                                  bad_deck([](BridgeDeck& d) { d.n_spans = 20; }),
                                                  bad_deck([](BridgeDeck& d) { d.bodies = 2000000000; }),
                                                  bad_deck([](BridgeDeck& d) { d.bodies = 0; })};
  for (std::size_t i = 0; i < faults.size(); ++i) EXPECT_THROW(faults[i](), std::invalid_argument) << "fault " << i;
}

}  // namespace
}  // namespace core::simulation
