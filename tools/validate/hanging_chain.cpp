#include "tools/validate/hanging_chain.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace tools {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kGravityOfChain_m_s2 = 9.80665;

// Axes: along the chord upwards, and normal to it in the vertical plane.
struct Rest {
  double free_m = 0.0;           // unstretched length of a bar
  std::vector<Vector2d> force;   // of each bar on its lower end
  std::vector<Vector2d> across;  // from its lower end to its upper one
  double mean_n = 0.0;
};

// Bars are stretched by the mean tension; a hundredth of that by its variation is left out.
double node_kg(const HangingChain& chain, double free_m) {
  return chain.mass_per_m_kg * free_m * (1.0 + chain.tension_n / chain.ea_n);
}

// From the force in the first bar, each next one carries the weight of one node more.
Rest laid_out(const HangingChain& chain, const Vector2d& first, double free_m) {
  const double slope = chain.slope_deg * std::numbers::pi / 180;
  const double weight = node_kg(chain, free_m) * kGravityOfChain_m_s2;
  const Vector2d down(-weight * std::sin(slope), -weight * std::cos(slope));
  Rest out;
  out.free_m = free_m;
  Vector2d force = first;
  for (int i = 0; i < chain.n_bars; ++i, force -= down) {
    const double size = force.norm();
    out.force.push_back(force);
    out.across.emplace_back(force * (free_m * (1.0 + size / chain.ea_n) / size));
    out.mean_n += size / chain.n_bars;
  }
  return out;
}

// Newton's method for the force in the first bar and the unstretched length: ends where they are, mean tension as
// asked.
Rest at_rest(const HangingChain& chain) {
  const double slope = chain.slope_deg * std::numbers::pi / 180;
  const double half = 0.5 * chain.mass_per_m_kg * chain.chord_m * kGravityOfChain_m_s2, t = chain.tension_n;
  const Vector3d scale(t, t, chain.chord_m / chain.n_bars);
  Vector3d x(1.0 - half * std::sin(slope) / t, -half * std::cos(slope) / t, 1.0 - t / chain.ea_n);
  const auto miss = [&](const Vector3d& at) -> Vector3d {
    const Rest rest = laid_out(chain, {scale(0) * at(0), scale(1) * at(1)}, scale(2) * at(2));
    Vector2d end = Vector2d::Zero();
    for (const Vector2d& bar : rest.across) end += bar;
    return {end(0) / chain.chord_m - 1.0, end(1) / chain.chord_m, rest.mean_n / t - 1.0};
  };
  for (int step = 0; step < 30; ++step) {
    const Vector3d off = miss(x);
    if (off.norm() < 1e-12) return laid_out(chain, {scale(0) * x(0), scale(1) * x(1)}, scale(2) * x(2));
    Eigen::Matrix3d slope_of;
    for (Index k = 0; k < 3; ++k) slope_of.col(k) = (miss(x + 1e-6 * Vector3d::Unit(k)) - off) / 1e-6;
    x -= slope_of.partialPivLu().solve(off);
  }
  throw std::runtime_error("the hanging chain finds no rest");
}

// Stiffness about the state of rest: bars, their forces, and bending as a moment at each node over the change of
// direction of its two bars. Degrees of freedom: along and across at nodes 1 .. n_bars - 1.
Eigen::SparseMatrix<double> stiffness_of(const HangingChain& chain, const Rest& rest) {
  const Index n = chain.n_bars;
  std::vector<Eigen::Triplet<double>> parts;
  const auto add = [&](Index node_i, Index axis_i, Index node_j, Index axis_j, double value) {
    if (node_i < 1 || node_j < 1 || node_i >= n || node_j >= n) return;
    parts.emplace_back(2 * (node_i - 1) + axis_i, 2 * (node_j - 1) + axis_j, value);
  };
  for (Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double length = rest.across[at].norm();
    const Vector2d along = rest.across[at] / length;
    const Eigen::Matrix2d outer = along * along.transpose();
    const Eigen::Matrix2d k =
        chain.ea_n / rest.free_m * outer + rest.force[at].norm() / length * (Eigen::Matrix2d::Identity() - outer);
    for (Index a = 0; a < 2; ++a) {
      for (Index b = 0; b < 2; ++b) {
        add(i, a, i, b, k(a, b)), add(i + 1, a, i + 1, b, k(a, b));
        add(i, a, i + 1, b, -k(a, b)), add(i + 1, a, i, b, -k(a, b));
      }
    }
  }
  const double bend = chain.ei_nm2 / std::pow(rest.free_m, 3);
  for (Index i = 1; i < n; ++i) {
    const double weights[] = {1.0, -2.0, 1.0};
    for (Index a = 0; a < 3; ++a) {
      for (Index b = 0; b < 3; ++b) add(i - 1 + a, 1, i - 1 + b, 1, bend * weights[a] * weights[b]);
    }
  }
  // Held ends: the mirror image beyond them, over half a bar.
  add(1, 1, 1, 1, 2.0 * bend), add(n - 1, 1, n - 1, 1, 2.0 * bend);
  Eigen::SparseMatrix<double> out(2 * (n - 1), 2 * (n - 1));
  out.setFromTriplets(parts.begin(), parts.end());
  return out;
}

}  // namespace

ChainModes chain_modes(const HangingChain& chain, const std::vector<double>& places, int n_modes) {
  const Rest rest = at_rest(chain);
  const Eigen::SparseMatrix<double> k = stiffness_of(chain, rest);
  const double kg = node_kg(chain, rest.free_m);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(k);
  if (factor.info() != Eigen::Success) throw std::runtime_error("the hanging chain is not stable");
  // Subspace iteration: the lowest modes are the largest of K^-1 m.
  MatrixXd x(k.rows(), 2 * n_modes + 8);
  for (Index c = 0; c < x.cols(); ++c) {
    for (Index r = 0; r < x.rows(); ++r)
      x(r, c) = std::sin(std::numbers::pi * static_cast<double>((c / 2 + 1) * (r / 2 + 1)) / chain.n_bars) *
                (r % 2 == (c + 1) % 2 ? 1.0 : 0.01);
  }
  VectorXd square = VectorXd::Zero(n_modes);  // circular frequencies
  for (int step = 0; step < 200; ++step) {
    const MatrixXd y = factor.solve(kg * x);
    const MatrixXd reduced_k = y.transpose() * (k * y), reduced_m = kg * (y.transpose() * y);
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(reduced_k, reduced_m);
    x = y * solver.eigenvectors();
    const VectorXd now = solver.eigenvalues().head(n_modes);
    const bool done = ((now - square).cwiseAbs().array() < 1e-10 * now.array()).all();
    square = now;
    if (done) break;
  }
  ChainModes out;
  out.frequency_hz = square.cwiseSqrt() / (2.0 * std::numbers::pi);
  out.shapes.resize(static_cast<Index>(places.size()), n_modes);
  std::vector<double> along{0.0};  // of the nodes
  double normal = 0.0;
  for (const Vector2d& bar : rest.across) {
    along.push_back(along.back() + bar(0) / chain.chord_m), normal += bar(1);
    out.sag_m = std::max(out.sag_m, std::abs(normal));
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto above = std::upper_bound(along.begin() + 2, along.end() - 2, places[i]) - along.begin();
    const double share = (places[i] - along[static_cast<std::size_t>(above - 1)]) /
                         (along[static_cast<std::size_t>(above)] - along[static_cast<std::size_t>(above - 1)]);
    out.shapes.row(static_cast<Index>(i)) =
        (1.0 - share) * x.row(2 * (above - 2) + 1).head(n_modes) + share * x.row(2 * (above - 1) + 1).head(n_modes);
  }
  return out;
}

}  // namespace tools
