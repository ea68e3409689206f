#include "core/structure/affine_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/structure/dense_modes.h"

namespace core::structure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kMostRigid = 3;       // motions of a rigid body in a plane
constexpr double kLeastRigid = 1e-6;  // lambda over the shift below which motion is that of a rigid body

void add(MatrixXd& out, const SparseMatrix& part, double factor) {
  if (factor == 0.0) return;
  for (int c = 0; c < part.outerSize(); ++c) {
    for (SparseMatrix::InnerIterator it(part, c); it; ++it) out(it.row(), it.col()) += factor * it.value();
  }
}

double whole_power(double p, int power) noexcept {
  double out = 1.0;
  for (int i = 0; i < std::abs(power); ++i) out *= p;
  return power < 0 ? 1.0 / out : out;
}

// Modes that are kept: columns of the pairs, in ascending order of frequency.
std::vector<Index> elastic_modes(const DensePairs& pairs, std::size_t n_modes) {
  std::vector<Index> out;
  const double least = 1e-30 * pairs.mu(0);
  for (Index r = 0; r < pairs.x.cols() && out.size() < n_modes; ++r) {
    if (!(pairs.mu(r) > least)) break;  // no mass takes part
    if (pairs.shift > 0.0 && 1.0 / pairs.mu(r) - pairs.shift < kLeastRigid * pairs.shift) continue;
    out.push_back(r);
  }
  return out;
}

}  // namespace

double Factor::value(double p) const noexcept {
  switch (law) {
    case Law::kReciprocal:
      return 1.0 / std::max(p, least);
    case Law::kLagrange: {
      double out = 1.0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (i != at) out *= (p - points[i]) / (points[at] - points[i]);
      }
      return out;
    }
    default:
      return whole_power(p, power);
  }
}

double Factor::slope(double p) const noexcept {
  switch (law) {
    case Law::kReciprocal:
      return -1.0 / (std::max(p, least) * std::max(p, least));
    case Law::kLagrange: {
      double out = 0.0;
      for (std::size_t k = 0; k < points.size(); ++k) {
        if (k == at) continue;
        double one = 1.0 / (points[at] - points[k]);
        for (std::size_t i = 0; i < points.size(); ++i) {
          if (i != at && i != k) one *= (p - points[i]) / (points[at] - points[i]);
        }
        out += one;
      }
      return out;
    }
    default:
      return power == 0 ? 0.0 : power * whole_power(p, power - 1);
  }
}

double AffineTerm::value(const VectorXd& values) const noexcept {
  double out = 1.0;
  for (const Factor& factor : factors) out *= factor.value(values(static_cast<Index>(factor.parameter)));
  return out;
}

double AffineTerm::slope(const VectorXd& values, std::size_t parameter) const noexcept {
  double out = 0.0;
  for (std::size_t f = 0; f < factors.size(); ++f) {
    if (factors[f].parameter != parameter) continue;
    double one = factors[f].slope(values(static_cast<Index>(parameter)));
    for (std::size_t g = 0; g < factors.size(); ++g) {
      if (g != f) one *= factors[g].value(values(static_cast<Index>(factors[g].parameter)));
    }
    out += one;
  }
  return out;
}

AffineModel::AffineModel(AffineMatrices matrices) : matrices_(std::move(matrices)) {}

MatrixXd AffineModel::stiffness(const VectorXd& values) const {
  MatrixXd k(matrices_.stiffness);
  for (const AffineTerm& term : matrices_.terms) add(k, term.stiffness, term.value(values));
  return k;
}

MatrixXd AffineModel::mass(const VectorXd& values) const {
  MatrixXd m(matrices_.mass);
  for (const AffineTerm& term : matrices_.terms) add(m, term.mass, term.value(values));
  return m;
}

std::vector<Index> AffineModel::moving(const VectorXd& values, const std::vector<std::size_t>& derivatives) const {
  std::vector<bool> is_static(static_cast<std::size_t>(matrices_.stiffness.rows()), false);
  for (const RigidPart& part : matrices_.rigid) {
    const bool is_sought = std::find(derivatives.begin(), derivatives.end(), part.parameter) != derivatives.end();
    if (values(static_cast<Index>(part.parameter)) != 0.0 || is_sought) continue;
    for (const Index dof : part.dofs) is_static[static_cast<std::size_t>(dof)] = true;
  }
  std::vector<Index> out;
  for (Index i = 0; i < matrices_.stiffness.rows(); ++i) {
    if (!is_static[static_cast<std::size_t>(i)]) out.push_back(i);
  }
  return out;
}

std::optional<ModelModes> AffineModel::modes(const VectorXd& values, std::size_t n_modes,
                                             const std::vector<std::size_t>& derivatives) const {
  // Derivatives of shapes are sums over all modes; else those wanted, and rigid-body motion.
  const std::vector<Index> moved = moving(values, derivatives);
  const bool is_all = moved.size() == static_cast<std::size_t>(matrices_.stiffness.rows());
  const auto of_moved = [&](const MatrixXd& whole) { return is_all ? whole : MatrixXd(whole(moved, moved)); };
  const Index n_vectors =
      derivatives.empty() ? static_cast<Index>(n_modes) + kMostRigid : static_cast<Index>(moved.size());
  const auto pairs = dense_pairs(of_moved(stiffness(values)), of_moved(mass(values)), n_vectors);
  if (!pairs) return std::nullopt;
  const std::vector<Index> kept = elastic_modes(*pairs, n_modes);
  if (kept.empty()) return std::nullopt;
  const auto n = static_cast<Index>(kept.size());
  const MatrixXd readout = is_all ? matrices_.readout : MatrixXd(matrices_.readout(Eigen::all, moved));
  const MatrixXd seen = readout * pairs->x;  // sights x pairs
  ModelModes out;
  out.frequency_hz.resize(n);
  out.shapes.resize(seen.rows(), n);
  VectorXd raised(n), root(n);  // lambda + shift, and its root: from x' K x = 1 to modal mass 1
  for (Index r = 0; r < n; ++r) {
    const Index column = kept[static_cast<std::size_t>(r)];
    raised(r) = 1.0 / pairs->mu(column);
    root(r) = std::sqrt(raised(r));
    const double lambda = raised(r) - pairs->shift;
    if (!(lambda > 0.0)) return std::nullopt;
    out.frequency_hz(r) = std::sqrt(lambda) / (2.0 * std::numbers::pi);
    out.shapes.col(r) = root(r) * seen.col(column);
  }
  if (derivatives.empty()) return out;
  out.d_frequency_hz.resize(n, static_cast<Index>(derivatives.size()));
  for (std::size_t d = 0; d < derivatives.size(); ++d) {
    SparseMatrix dk(matrices_.stiffness.rows(), matrices_.stiffness.rows()), dm = dk;
    for (const AffineTerm& term : matrices_.terms) {
      const double slope = term.slope(values, derivatives[d]);
      if (slope == 0.0) continue;
      if (term.stiffness.rows() > 0) dk += slope * term.stiffness;
      if (term.mass.rows() > 0) dm += slope * term.mass;
    }
    MatrixXd d_shape(seen.rows(), n);
    for (Index r = 0; r < n; ++r) {
      const Index column = kept[static_cast<std::size_t>(r)];
      VectorXd whole = VectorXd::Zero(matrices_.stiffness.rows());
      whole(moved) = root(r) * pairs->x.col(column);
      const double lambda = raised(r) - pairs->shift;
      const VectorXd phi = whole(moved);
      const VectorXd mass_part = (dm * whole)(moved);
      const VectorXd force = (dk * whole)(moved)-lambda * mass_part;
      const double d_lambda = phi.dot(force);
      out.d_frequency_hz(r, static_cast<Index>(d)) =
          d_lambda / (8.0 * std::numbers::pi * std::numbers::pi * out.frequency_hz(r));
      VectorXd along = -(pairs->x.transpose() * force);
      for (Index s = 0; s < along.size(); ++s) {
        const double gap = 1.0 - raised(r) * pairs->mu(s);
        along(s) = std::abs(gap) > 1e-9 ? along(s) / gap : 0.0;
      }
      d_shape.col(r) = seen * along - 0.5 * phi.dot(mass_part) * out.shapes.col(r);
    }
    out.d_shapes.push_back(std::move(d_shape));
  }
  return out;
}

}  // namespace core::structure
