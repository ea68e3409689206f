#include "core/simulation/structure/structure_response.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "core/simulation/presets.h"
#include "core/simulation/random_stream.h"
#include "core/simulation/scene.h"

namespace core::simulation {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

StructureResponse paper_response(std::uint64_t seed, double duration_s, double grid_rate_hz = 200.0) {
  return StructureResponse(make_paper_scene(seed, duration_s), grid_rate_hz);
}

// Modal coordinate r of the displacements relative to the base: uniform masses make the shapes orthogonal.
double modal_coordinate(const StructureResponse& response, const Eigen::MatrixXd& shapes, Eigen::Index r, double t_s) {
  double q = 0.0;
  for (int floor = 1; floor < response.n_bodies(); ++floor) {
    q += shapes(floor - 1, r) * (response.displacement_mm(floor, t_s) - response.displacement_mm(0, t_s));
  }
  return q / shapes.col(r).squaredNorm();
}

template <class F>
double first_derivative(const F& f, double t, double h) {
  return (8.0 * (f(t + h) - f(t - h)) - (f(t + 2 * h) - f(t - 2 * h))) / (12.0 * h);
}

template <class F>
double second_derivative(const F& f, double t, double h) {
  return (16.0 * (f(t + h) + f(t - h)) - (f(t + 2 * h) + f(t - 2 * h)) - 30.0 * f(t)) / (12.0 * h * h);
}

TEST(StructureResponse, HasTheDeclaredRoofRmsOverTheClip) {
  for (const double duration_s : {20.0, 60.0, 300.0}) {
    const StructureResponse response = paper_response(5, duration_s);
    double sum = 0.0;
    constexpr int kN = 20000;
    for (int i = 0; i < kN; ++i) {
      const double t_s = duration_s * (i + 0.5) / kN;
      const double roof = response.displacement_mm(6, t_s) - response.displacement_mm(0, t_s);
      sum += roof * roof;
    }
    EXPECT_NEAR(std::sqrt(sum / kN), 4.0, 0.01);
    EXPECT_NEAR(response.roof_relative_rms_mm(), 4.0, 1e-9);
  }
}

TEST(StructureResponse, InterpolatesTo1e4OfTheRoofRms) {
  const StructureResponse response = paper_response(1, 60.0), fine = paper_response(1, 60.0, 1600.0);
  RandomStream stream(1, "times");
  for (int i = 0; i < 1000; ++i) {
    const double t_s = 60.0 * stream.uniform();
    for (int body = 0; body < 7; ++body) {
      ASSERT_NEAR(response.displacement_mm(body, t_s), fine.displacement_mm(body, t_s), 1e-4 * 4.0) << t_s;
    }
  }
}

// q'' + 2 zeta w q' + w^2 q = -participation * base acceleration, from displacements alone.
TEST(StructureResponse, ObeysTheEquationOfMotionOfEveryMode) {
  const std::vector<TrueMode> modes = modes_of(make_paper_scene(3, 20.0).structure);
  const StructureResponse response = paper_response(3, 20.0, 3200.0);
  const Eigen::MatrixXd shapes = shear_chain_shapes(6);
  constexpr double kStep_s = 1e-3;
  for (Eigen::Index r = 0; r < 6; ++r) {
    const double w = kTwoPi * modes[static_cast<std::size_t>(r)].frequency_hz;
    const double participation = shapes.col(r).sum() / shapes.col(r).squaredNorm();
    double residual = 0.0, scale = 0.0;
    for (double t_s = 1.0; t_s < 19.0; t_s += 0.037) {
      const auto q = [&](double t) { return modal_coordinate(response, shapes, r, t); };
      const auto base = [&](double t) { return response.displacement_mm(0, t); };
      const double force = -participation * second_derivative(base, t_s, kStep_s);
      const double left =
          second_derivative(q, t_s, kStep_s) + 2.0 * 0.01 * w * first_derivative(q, t_s, kStep_s) + w * w * q(t_s);
      residual += (left - force) * (left - force);
      scale += force * force;
    }
    EXPECT_LT(std::sqrt(residual / scale), 2e-3) << "mode " << r + 1;
  }
}

// Whittle's likelihood of the periodogram around each mode, damping known: its scatter is the bound
// sqrt(zeta / (2 pi f T)), so the estimate must agree within a few of them.
TEST(StructureResponse, PeaksAtTheDeclaredFrequencies) {
  const std::vector<TrueMode> modes = modes_of(make_paper_scene(2, 60.0).structure);
  constexpr double kDuration_s = 300.0, kRate_hz = 60.0;
  const StructureResponse response = paper_response(2, kDuration_s);
  const Eigen::MatrixXd shapes = shear_chain_shapes(6);
  for (Eigen::Index r = 0; r < 6; ++r) {
    const double f = modes[static_cast<std::size_t>(r)].frequency_hz;
    std::vector<double> q;
    for (int i = 0; i < static_cast<int>(kDuration_s * kRate_hz); ++i) {
      const double taper = std::sin(std::numbers::pi * (i + 0.5) / (kDuration_s * kRate_hz));
      q.push_back(taper * modal_coordinate(response, shapes, r, i / kRate_hz));
    }
    std::vector<std::pair<double, double>> periodogram;  // Hz, power
    for (double g = 0.93 * f; g < 1.07 * f; g += 1.0 / kDuration_s) {
      std::complex<double> sum = 0.0;
      for (std::size_t i = 0; i < q.size(); ++i)
        sum += q[i] * std::polar(1.0, -kTwoPi * g * static_cast<double>(i) / kRate_hz);
      periodogram.emplace_back(g, std::norm(sum));
    }
    double best = 0.0, best_score = 1e300;
    for (double trial = 0.97 * f; trial < 1.03 * f; trial += 1e-4 * f) {
      double level = 0.0, log_sum = 0.0;
      for (const auto& [g, power] : periodogram) {
        const double d = trial * trial - g * g, e = 0.02 * trial * g;
        const double shape = 1.0 / (d * d + e * e);
        level += power / shape;
        log_sum += std::log(shape);
      }
      const double n = static_cast<double>(periodogram.size());
      const double score = n * std::log(level / n) + log_sum;
      if (score < best_score) best_score = score, best = trial;
    }
    const double scatter = std::sqrt(0.01 / (kTwoPi * f * kDuration_s));
    EXPECT_NEAR(best / f, 1.0, 4.0 * scatter) << "mode " << r + 1;
  }
}

TEST(StructureResponse, MovesDifferentlyForAnotherSeed) {
  const StructureResponse a = paper_response(1, 10.0), b = paper_response(2, 10.0);
  EXPECT_NE(a.displacement_mm(6, 3.0), b.displacement_mm(6, 3.0));
}

TEST(StructureResponse, StandsStillWhenNotShaken) {
  Scene scene = make_paper_scene(1, 10.0);
  scene.excitation.rms_mm = 0.0;
  const StructureResponse response(scene);
  EXPECT_EQ(response.n_bodies(), 7);
  EXPECT_EQ(response.displacement_mm(6, 3.0), 0.0);
  EXPECT_EQ(response.rms_mm(6), 0.0);
}

// A machine on the roof: the sum over the modes of phi phi^T / (w_r^2 - w^2 + 2 i zeta w_r w), scaled to its own body.
TEST(StructureResponse, AnswersAHarmonicForceInItsSteadyState) {
  Scene scene = make_paper_scene(1, 20.0);
  scene.excitation.rms_mm = 0.0;
  scene.excitation.harmonics = {{6, 3.3, 2.0}};
  const StructureResponse response(scene);
  const Eigen::MatrixXd shapes = shear_chain_shapes(6);
  const std::vector<TrueMode> modes = modes_of(scene.structure);
  const double w = kTwoPi * 3.3;
  std::vector<std::complex<double>> receptance(6);
  for (Eigen::Index r = 0; r < 6; ++r) {
    const double wr = kTwoPi * modes[static_cast<std::size_t>(r)].frequency_hz;
    for (Eigen::Index i = 0; i < 6; ++i) {
      receptance[static_cast<std::size_t>(i)] += shapes(5, r) * shapes(i, r) / shapes.col(r).squaredNorm() /
                                                 std::complex<double>(wr * wr - w * w, 0.02 * wr * w);
    }
  }
  for (int body = 1; body <= 6; ++body) {
    std::complex<double> amplitude = 0.0, roof = 0.0;
    constexpr int kN = 3300;  // a whole number of periods in 10 s
    for (int i = 0; i < kN; ++i) {
      const double t_s = 10.0 * i / kN;
      amplitude += 2.0 / kN * response.displacement_mm(body, t_s) * std::polar(1.0, -w * t_s);
      roof += 2.0 / kN * response.displacement_mm(6, t_s) * std::polar(1.0, -w * t_s);
    }
    EXPECT_NEAR(std::abs(roof), 2.0 * std::numbers::sqrt2, 1e-9);
    EXPECT_LT(std::abs(amplitude / roof - receptance[static_cast<std::size_t>(body) - 1] / receptance[5]), 1e-9);
  }
}

// A model with dashpots of its own has complex shapes; the poles of its modes solve the quadratic eigenvalue problem.
TEST(StructureModel, HasThePolesOfItsEquationOfMotion) {
  StructureModel model = uniform_chain({1.0, 2.5, 4.0}, {0.01, 0.02, 0.03});
  model.damping(0, 1) = model.damping(1, 0) = 0.2;
  for (const TrueMode& mode : modes_of(model)) {
    const double w = kTwoPi * mode.frequency_hz;
    const std::complex<double> s(-mode.damping_ratio * w, w * std::sqrt(1.0 - mode.damping_ratio * mode.damping_ratio));
    const Eigen::MatrixXcd dynamic =
        model.stiffness.cast<std::complex<double>>() + s * model.damping + s * s * model.mass;
    const Eigen::VectorXcd q = model.displacement.cast<std::complex<double>>().inverse() * mode.displacement;
    EXPECT_LT((dynamic * q).norm(), 1e-9 * model.stiffness.norm() * q.norm());
  }
}

// Switching the forces off does not change a bit of the ground's motion.
TEST(StructureResponse, DrawsForcesAndGroundFromStreamsOfTheirOwn) {
  Scene base = make_paper_scene(4, 20.0), both = base;
  both.excitation.forces = 0.5;
  const StructureResponse a(base), b(both);
  for (const double t_s : {1.0, 7.7, 15.2}) {
    EXPECT_EQ(b.displacement_mm(0, t_s), a.displacement_mm(0, t_s));
    EXPECT_GT(std::abs(b.displacement_mm(3, t_s) - a.displacement_mm(3, t_s)), 1e-3);
  }
}

TEST(ShearChainShapes, AreOrthogonalAndScaledToOne) {
  const Eigen::MatrixXd shapes = shear_chain_shapes(6);
  for (Eigen::Index r = 0; r < 6; ++r) {
    EXPECT_DOUBLE_EQ(shapes.col(r).maxCoeff(), 1.0);
    EXPECT_LE(-shapes.col(r).minCoeff(), 1.0);
    for (Eigen::Index s = 0; s < r; ++s) EXPECT_NEAR(shapes.col(r).dot(shapes.col(s)), 0.0, 1e-12);
  }
}

}  // namespace
}  // namespace core::simulation
