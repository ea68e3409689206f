#include "core/structure/kinds/matrices.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/linear/symmetric_eigen.h"
#include "core/structure/fem/sparse_modes.h"
#include "core/structure/kinds/declared_value.h"

namespace core::structure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kMostDirections = 48;     // of the response to changes of groups
constexpr double kLeastResponse = 1e-10;  // square of a direction's share, relative to the largest response
constexpr double kSymmetric = 1e-9;       // relative to the largest element
constexpr double kLowest_hz = 1e-4, kHighest_hz = 1e6;

void check_matrix(const SparseMatrix& a, Index n, const std::string& what) {
  if (a.rows() != n || a.cols() != n)
    refuse_declaration(what, " is ", a.rows(), " x ", a.cols(), "; the stiffness matrix has ", n,
                       " rows: export all with the same degrees of freedom");
  double largest = 0.0;
  for (int c = 0; c < a.outerSize(); ++c) {
    for (SparseMatrix::InnerIterator it(a, c); it; ++it) {
      if (!std::isfinite(it.value()))
        refuse_declaration(what, ": element ", it.row() + 1, ", ", c + 1, " is no number");
      largest = std::max(largest, std::abs(it.value()));
    }
  }
  const SparseMatrix off = a - SparseMatrix(a.transpose());
  for (int c = 0; c < off.outerSize(); ++c) {
    for (SparseMatrix::InnerIterator it(off, c); it; ++it) {
      if (std::abs(it.value()) > kSymmetric * largest)
        refuse_declaration(what, " is not symmetric: elements ", it.row() + 1, ", ", c + 1, " and ", c + 1, ", ",
                           it.row() + 1, " differ by ", std::abs(it.value()),
                           "; a gyroscopic or follower-force model does not fit here");
    }
  }
}

void check(const MatrixStructure& s) {
  const Index n = s.stiffness.rows();
  if (n < 1 || static_cast<std::size_t>(n) > kMostMatrixDofs)
    refuse_declaration("the stiffness matrix has ", n, " rows: allowed 1 .. ", kMostMatrixDofs);
  if (s.groups.size() > kMostMatrixGroups)
    refuse_declaration(s.groups.size(), " groups are refused: allowed up to ", kMostMatrixGroups);
  check_matrix(s.stiffness, n, "the stiffness matrix");
  check_matrix(s.mass, n, "the mass matrix");
  for (const auto& group : s.groups) {
    if (group.stiffness.rows() > 0) check_matrix(group.stiffness, n, "group " + group.name + ": its stiffness matrix");
    if (group.mass.rows() > 0) check_matrix(group.mass, n, "group " + group.name + ": its mass matrix");
  }
  for (const auto& seen : s.seen) {
    for (const auto& [dof, weight] : seen.dofs) {
      if (dof >= static_cast<std::size_t>(n))
        refuse_declaration("map: `", seen.channel, "` names degree of freedom ", dof + 1, "; there are ", n);
    }
  }
}

void check_frequencies(const SparseModes& modes) {
  const double hz = std::sqrt(std::max(modes.lambda.maxCoeff(), 0.0)) / (2.0 * std::numbers::pi);
  if (!(hz > kLowest_hz && hz < kHighest_hz))
    refuse_declaration("the model's highest requested mode is at ", hz,
                       " Hz, which no structure has: units of K and M do not agree (N/m with kg, N/mm with t)");
}

MatrixXd readout_of(const MatrixStructure& s) {
  MatrixXd out = MatrixXd::Zero(static_cast<Index>(s.seen.size()), s.stiffness.rows());
  for (std::size_t i = 0; i < s.seen.size(); ++i) {
    for (const auto& [dof, weight] : s.seen[i].dofs) out(static_cast<Index>(i), static_cast<Index>(dof)) += weight;
  }
  return out;
}

// Directions in which the modes change when a group does, beside the modes themselves: the leading ones of
// (K + shift M)^-1 K_i x_r, orthonormal in M.
MatrixXd response_directions(const MatrixStructure& s, const SparseFactor& factor, const SparseModes& modes) {
  const Index n = s.stiffness.rows(), n_modes = std::min<Index>(static_cast<Index>(s.n_modes), modes.x.cols());
  MatrixXd all(n, 0);
  double largest = 0.0;  // square of a response before the modes' part of it is removed
  for (const auto& group : s.groups) {
    MatrixXd force(n, n_modes);
    for (Index r = 0; r < n_modes; ++r) {
      force.col(r).setZero();
      if (group.stiffness.rows() > 0) force.col(r) += group.stiffness * modes.x.col(r);
      if (group.mass.rows() > 0) force.col(r) -= modes.lambda(r) * (group.mass * modes.x.col(r));
    }
    MatrixXd response = factor.solve(force);
    largest = std::max(largest, (s.mass * response).cwiseProduct(response).colwise().sum().maxCoeff());
    for (int pass = 0; pass < 2; ++pass) response -= modes.x * (modes.x.transpose() * (s.mass * response));
    all.conservativeResize(Eigen::NoChange, all.cols() + n_modes);
    all.rightCols(n_modes) = response;
  }
  if (all.cols() == 0) return all;
  MatrixXd gram = all.transpose() * (s.mass * all);
  const SymmetricEigen eigen(0.5 * (gram + gram.transpose()));
  Index kept = 0;
  while (kept < std::min(kMostDirections, gram.rows()) && eigen.values()(kept) > kLeastResponse * largest) ++kept;
  if (kept == 0) return MatrixXd(n, 0);
  const MatrixXd vectors = eigen.leading_vectors(kept);
  return all * vectors * eigen.values().head(kept).cwiseSqrt().cwiseInverse().asDiagonal();
}

SparseMatrix reduced(const SparseMatrix& a, const MatrixXd& basis) {
  const MatrixXd dense = basis.transpose() * (a * basis);
  return (0.5 * (dense + dense.transpose())).sparseView();
}

}  // namespace

std::unique_ptr<StructuralModel> make_matrices(const MatrixStructure& s) {
  check(s);
  const SparseFactor factor(s.stiffness, s.mass);
  const SparseModes modes = lowest_modes(factor, s.mass, 2 * s.n_modes);
  check_frequencies(modes);
  const MatrixXd directions = response_directions(s, factor, modes);
  MatrixXd basis(s.stiffness.rows(), modes.x.cols() + directions.cols());
  basis << modes.x, directions;
  AffineMatrices out;
  out.kind = "matrices";
  out.stiffness = reduced(s.stiffness, basis), out.mass = reduced(s.mass, basis);
  for (std::size_t i = 0; i < s.groups.size(); ++i) {
    const auto& group = s.groups[i];
    ModelParameter p;
    p.name = "factor_" + group.name, p.unit = "1", p.role = Role::kPartStiffness, p.place = group.name;
    p.value = 1.0, p.low = 0.05, p.high = 20.0, p.scale = 0.2, p.prior_sigma = group.prior;
    if (group.stiffness.rows() == 0) p.role = Role::kOther;
    out.parameters.push_back(std::move(p));
    AffineTerm term;
    term.factors = {Factor::of_power(i, 1)};
    if (group.stiffness.rows() > 0) {
      term.stiffness = reduced(group.stiffness, basis);
      out.stiffness -= term.stiffness;
    }
    if (group.mass.rows() > 0) {
      term.mass = reduced(group.mass, basis);
      out.mass -= term.mass;
    }
    out.terms.push_back(std::move(term));
  }
  out.readout = readout_of(s) * basis;
  for (const auto& seen : s.seen) out.sights.push_back({seen.channel, {}, Eigen::Vector3d::UnitX()});
  return std::make_unique<AffineModel>(std::move(out));
}

ModelModes exact_modes(const MatrixStructure& s, const std::vector<double>& factors, std::size_t n_modes) {
  check(s);
  SparseMatrix k = s.stiffness, m = s.mass;
  for (std::size_t i = 0; i < s.groups.size(); ++i) {
    if (s.groups[i].stiffness.rows() > 0) k += (factors[i] - 1.0) * s.groups[i].stiffness;
    if (s.groups[i].mass.rows() > 0) m += (factors[i] - 1.0) * s.groups[i].mass;
  }
  const SparseModes modes = lowest_modes(SparseFactor(k, m), m, n_modes);
  check_frequencies(modes);
  ModelModes out;
  out.frequency_hz = modes.lambda.cwiseMax(0.0).cwiseSqrt() / (2.0 * std::numbers::pi);
  out.shapes = readout_of(s) * modes.x;
  return out;
}

}  // namespace core::structure
