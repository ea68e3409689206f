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
  for (int c = 0; c < part.outerSize(); ++c) {
    for (SparseMatrix::InnerIterator it(part, c); it; ++it) out(it.row(), it.col()) += factor * it.value();
  }
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

double coefficient(const AffineTerm& term, double p) noexcept {
  switch (term.law) {
    case Law::kReciprocal:
      return 1.0 / std::max(p, term.least);
    case Law::kInverseSquare:
      return 1.0 / (p * p);
    default:
      return p;
  }
}

double coefficient_slope(const AffineTerm& term, double p) noexcept {
  switch (term.law) {
    case Law::kReciprocal:
      return -1.0 / (std::max(p, term.least) * std::max(p, term.least));
    case Law::kInverseSquare:
      return -2.0 / (p * p * p);
    default:
      return 1.0;
  }
}

AffineModel::AffineModel(AffineMatrices matrices) : matrices_(std::move(matrices)) {}

MatrixXd AffineModel::stiffness(const VectorXd& values) const {
  MatrixXd k(matrices_.stiffness);
  for (const AffineTerm& term : matrices_.terms)
    add(k, term.stiffness, coefficient(term, values(static_cast<Index>(term.parameter))));
  return k;
}

MatrixXd AffineModel::mass(const VectorXd& values) const {
  MatrixXd m(matrices_.mass);
  for (const AffineTerm& term : matrices_.terms)
    add(m, term.mass, coefficient(term, values(static_cast<Index>(term.parameter))));
  return m;
}

std::optional<ModelModes> AffineModel::modes(const VectorXd& values, std::size_t n_modes,
                                             const std::vector<std::size_t>& derivatives) const {
  // Derivatives of shapes are sums over all modes; else those wanted, and rigid-body motion.
  const Index n_dof = matrices_.stiffness.rows();
  const Index n_vectors = derivatives.empty() ? static_cast<Index>(n_modes) + kMostRigid : n_dof;
  const auto pairs = dense_pairs(stiffness(values), mass(values), n_vectors);
  if (!pairs) return std::nullopt;
  const std::vector<Index> kept = elastic_modes(*pairs, n_modes);
  if (kept.empty()) return std::nullopt;
  const auto n = static_cast<Index>(kept.size());
  const MatrixXd seen = matrices_.readout * pairs->x;  // sights x pairs
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
    SparseMatrix dk(pairs->x.rows(), pairs->x.rows()), dm = dk;
    for (const AffineTerm& term : matrices_.terms) {
      if (term.parameter != derivatives[d]) continue;
      const double slope = coefficient_slope(term, values(static_cast<Index>(term.parameter)));
      if (term.stiffness.rows() > 0) dk += slope * term.stiffness;
      if (term.mass.rows() > 0) dm += slope * term.mass;
    }
    MatrixXd d_shape(seen.rows(), n);
    for (Index r = 0; r < n; ++r) {
      const Index column = kept[static_cast<std::size_t>(r)];
      const VectorXd phi = root(r) * pairs->x.col(column);
      const double lambda = raised(r) - pairs->shift;
      const VectorXd mass_part = dm * phi;
      const VectorXd force = dk * phi - lambda * mass_part;
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
