#include "core/simulation/structure/structure_response.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "core/simulation/presets.h"
#include "core/simulation/scene.h"
#include "core/simulation/structure/structure_builders.h"

namespace core::simulation {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

StructureModel paper_structure() { return make_paper_scene(1, 60.0).structure; }

// Dashpots far from proportional.
StructureModel odd_frame() {
  return shear_frame({{10.0, 8.0, 12.0}, {1.8e4, 1.2e4, 1.5e4}, 0.0, {}}, Dashpots{{4.0, 0.0, 40.0}});
}

ExcitationParameters shaken(double base, double forces) {
  ExcitationParameters excitation;
  excitation.base = base;
  excitation.forces = forces;
  return excitation;
}

Eigen::VectorXd relative(const StructureResponse& response, double t_s) {
  Eigen::VectorXd q(response.n_bodies() - 1);
  for (int body = 1; body < response.n_bodies(); ++body) {
    q(body - 1) = response.displacement_mm(body, t_s) - response.displacement_mm(0, t_s);
  }
  return q;
}

// Five-point central differences, exact to the fourth order.
template <class F>
auto first_derivative(const F& f, double t, double h) {
  return ((8.0 * (f(t + h) - f(t - h)) - (f(t + 2 * h) - f(t - 2 * h))) / (12.0 * h)).eval();
}

template <class F>
auto second_derivative(const F& f, double t, double h) {
  return ((16.0 * (f(t + h) + f(t - h)) - (f(t + 2 * h) + f(t - 2 * h)) - 30.0 * f(t)) / (12.0 * h * h)).eval();
}

// M q'' + C q' + K q = -L a, a the second derivative of the ground's displacement: from displacements alone.
TEST(StructureEffects, ObeysTheEquationsOfMotionOnAShakenGround) {
  const StructureModel model = odd_frame();
  const StructureResponse response(model, shaken(1.0, 0.0), 3, 20.0, 3200.0);
  const auto q = [&](double t) { return relative(response, t); };
  const auto ground = [&](double t) { return Eigen::VectorXd::Constant(1, response.displacement_mm(0, t)).eval(); };
  constexpr double kStep_s = 1e-3;
  double residual = 0.0, scale = 0.0;
  for (double t_s = 1.0; t_s < 19.0; t_s += 0.037) {
    const Eigen::VectorXd load = -model.influence * second_derivative(ground, t_s, kStep_s)(0);
    const Eigen::VectorXd left = model.mass * second_derivative(q, t_s, kStep_s) +
                                 model.damping * first_derivative(q, t_s, kStep_s) + model.stiffness * q(t_s);
    residual += (left - load).squaredNorm();
    scale += load.squaredNorm();
  }
  EXPECT_LT(std::sqrt(residual / scale), 2e-3);
}

// The same left side is the force: the same level on every body, and each body's own.
TEST(StructureEffects, IsDrivenByEqualIndependentForcesOnTheBodies) {
  const StructureModel model = odd_frame();
  const StructureResponse response(model, shaken(0.0, 1.0), 4, 200.0, 3200.0);
  const auto q = [&](double t) { return relative(response, t); };
  constexpr double kStep_s = 1e-3;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (double t_s = 1.0; t_s < 199.0; t_s += 0.0231) {
    const Eigen::VectorXd force = model.mass * second_derivative(q, t_s, kStep_s) +
                                  model.damping * first_derivative(q, t_s, kStep_s) + model.stiffness * q(t_s);
    covariance += force * force.transpose();
    ASSERT_EQ(response.displacement_mm(0, t_s), 0.0);
  }
  // 19.5 Hz for 198 s are 7700 independent values: levels to 1.6 %, correlations to 1.1 %.
  const double mean = covariance.trace() / 3.0;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(covariance(i, i) / mean, 1.0, 0.08);
    for (int j = 0; j < i; ++j) EXPECT_NEAR(covariance(i, j) / mean, 0.0, 0.05);
  }
  EXPECT_EQ(response.base_acceleration_rms_mm_s2(), 0.0);
  EXPECT_NEAR(response.roof_relative_rms_mm(), 4.0, 1e-9);
}

// Switching one effect does not change the others: each alone, the sum of all, and all but one.
TEST(StructureEffects, AddsItsEffectsAndLeavesEachAsItWas) {
  ExcitationParameters all = shaken(1.0, 0.7);
  all.harmonics = {{2, 6.1, 0.5}, {1, 11.0, 0.2}};
  ExcitationParameters ground = shaken(1.0, 0.0), forces = shaken(0.0, 0.7), lines = shaken(0.0, 0.0), quiet = all;
  lines.harmonics = all.harmonics;
  quiet.base = 0.0;
  const auto made = [](const ExcitationParameters& e) { return StructureResponse(odd_frame(), e, 8, 30.0); };
  const StructureResponse a = made(all), g = made(ground), f = made(forces), l = made(lines), q = made(quiet);
  for (double t_s = 0.0; t_s < 30.0; t_s += 0.31) {
    for (int body = 0; body <= 3; ++body) {
      const double sum = g.displacement_mm(body, t_s) + f.displacement_mm(body, t_s) + l.displacement_mm(body, t_s);
      EXPECT_NEAR(a.displacement_mm(body, t_s), sum, 1e-10);
      EXPECT_NEAR(q.displacement_mm(body, t_s), f.displacement_mm(body, t_s) + l.displacement_mm(body, t_s), 1e-10);
    }
    EXPECT_EQ(a.displacement_mm(0, t_s), g.displacement_mm(0, t_s));  // to the bit
  }
  EXPECT_NEAR(g.roof_relative_rms_mm(), 4.0, 1e-9);
  EXPECT_NEAR(f.roof_relative_rms_mm(), 0.7 * 4.0, 1e-9);
  EXPECT_EQ(l.roof_relative_rms_mm(), 0.0);
}

// Amplitude and phase per body as in response_at, and the stated rms on the body itself.
TEST(StructureEffects, StandsInTheHarmonicsSteadyState) {
  const StructureModel model = odd_frame();
  ExcitationParameters excitation = shaken(0.0, 0.0);
  excitation.harmonics = {{2, 6.1, 0.5}};
  const StructureResponse response(model, excitation, 8, 30.0);
  const double w = kTwoPi * 6.1;
  Eigen::VectorXcd force = Eigen::VectorXcd::Zero(3);
  force(1) = 1.0;
  const Eigen::VectorXcd q = response_at(model, w, force);
  const auto amplitude = [&](int body) {  // of exp(i w t), from two instants a quarter of a period apart
    return std::complex<double>(response.displacement_mm(body, 0.0),
                                -response.displacement_mm(body, 0.25 * kTwoPi / w));
  };
  EXPECT_NEAR(std::abs(amplitude(2)), 0.5 * std::numbers::sqrt2, 1e-12);
  for (int body = 1; body <= 3; ++body) {
    EXPECT_LT(std::abs(amplitude(body) / amplitude(2) - q(body - 1) / q(1)), 1e-9) << "body " << body;
    EXPECT_NEAR(response.displacement_mm(body, 7.0), (amplitude(body) * std::polar(1.0, w * 7.0)).real(), 1e-9);
  }
}

// A peak multiplies the ground's amplitude by 1 + gain there and does not change it far below.
TEST(StructureEffects, ColoursTheGroundByItsPeaks) {
  ExcitationParameters plain = shaken(1.0, 0.0), coloured = plain;
  coloured.base_peaks = {{5.0, 0.02, 3.0}};
  const StructureResponse a(odd_frame(), plain, 2, 400.0), b(odd_frame(), coloured, 2, 400.0);
  const auto ratio = [&](double f) {  // of the amplitudes at f, 400 s under a Hann window
    std::complex<double> x = 0.0, y = 0.0;
    for (int i = 0; i < 20000; ++i) {
      const double t_s = 0.02 * (i + 0.5);
      const auto e = std::polar(1.0 - std::cos(kTwoPi * t_s / 400.0), -kTwoPi * f * t_s);
      x += a.displacement_mm(0, t_s) * e;
      y += b.displacement_mm(0, t_s) * e;
    }
    return y / x;
  };
  EXPECT_LT(std::abs(ratio(5.0) - 4.0), 0.2);
  EXPECT_LT(std::abs(ratio(1.0) - 1.0), 0.05);
}

TEST(StructureEffects, TiltsAsItsModesDo) {
  Eigen::MatrixXd shapes(2, 2), tilts(2, 2);
  shapes << 0.4, 1.0, 1.0, -0.5;
  tilts << 2e-3, 1e-3, 3e-3, -4e-3;
  const StructureModel model = from_modes({1.5, 6.0}, {0.01, 0.02}, shapes, {3.0, 2.0}, tilts);
  ExcitationParameters excitation = shaken(1.0, 1.0);
  excitation.harmonics = {{1, 4.0, 0.3}};
  const StructureResponse response(model, excitation, 6, 20.0);
  ASSERT_TRUE(response.tilts());
  const Eigen::MatrixXd turn = tilts * shapes.inverse();
  for (double t_s = 0.0; t_s < 20.0; t_s += 0.17) {
    const Eigen::VectorXd expected = turn * relative(response, t_s);
    EXPECT_EQ(response.tilt_rad(0, t_s), 0.0);
    for (int body = 1; body <= 2; ++body) EXPECT_NEAR(response.tilt_rad(body, t_s), expected(body - 1), 1e-12);
  }
  EXPECT_FALSE(StructureResponse(odd_frame(), excitation, 6, 20.0).tilts());
}

TEST(StructureEffects, RestWhenNothingShakes) {
  ExcitationParameters excitation;
  excitation.rms_mm = 0.0;
  for (const ExcitationParameters& e : {excitation, shaken(0.0, 0.0)}) {
    const StructureResponse response(paper_structure(), e, 1, 10.0);
    EXPECT_EQ(response.n_bodies(), 7);
    EXPECT_EQ(response.displacement_mm(6, 3.0), 0.0);
    EXPECT_EQ(response.rms_mm(6), 0.0);
    EXPECT_EQ(response.roof_relative_rms_mm(), 0.0);
  }
}

TEST(StructureEffects, RefusesALevelForWhatMovesNothing) {
  StructureModel deaf = odd_frame();
  deaf.influence.setZero();
  EXPECT_THROW(StructureResponse(deaf, shaken(1.0, 0.0), 1, 10.0), std::invalid_argument);
  EXPECT_NO_THROW(StructureResponse(deaf, shaken(0.0, 1.0), 1, 10.0));
}

}  // namespace
}  // namespace core::simulation
