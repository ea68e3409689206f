#include "core/structure/fem/sparse_modes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/linear/symmetric_eigen.h"

namespace core::structure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kBlock = 4;
constexpr int kMostBlocks = 200;
constexpr double kConverged = 1e-11;      // residual of an eigenvalue, relative
constexpr double kLeastDirection = 1e-9;  // of a new vector after orthogonalisation, relative

// Numbers without a pattern, the same on every machine.
MatrixXd first_block(Index rows) {
  MatrixXd out(rows, kBlock);
  std::uint64_t state = 88172645463325252ULL;
  for (double& value : out.reshaped()) {
    state ^= state << 13U, state ^= state >> 7U, state ^= state << 17U;
    value = static_cast<double>(state >> 11U) * 0x1p-53 - 0.5;
  }
  return out;
}

// The parts of `block` outside `basis`, orthonormal in the inner product of M; parts within it are dropped.
MatrixXd new_directions(const MatrixXd& basis, MatrixXd block, const SparseMatrix& m) {
  MatrixXd out(block.rows(), 0);
  for (Index c = 0; c < block.cols(); ++c) {
    VectorXd v = block.col(c);
    const double before = std::sqrt(std::max(v.dot(m * v), 0.0));
    for (int pass = 0; pass < 2; ++pass) {
      const VectorXd mv = m * v;
      v -= basis * (basis.transpose() * mv);
      v -= out * (out.transpose() * mv);
    }
    const double norm = std::sqrt(std::max(v.dot(m * v), 0.0));
    if (!(norm > kLeastDirection * before)) continue;
    out.conservativeResize(Eigen::NoChange, out.cols() + 1);
    out.col(out.cols() - 1) = v / norm;
  }
  return out;
}

struct Ritz {
  VectorXd mu;  // descending
  MatrixXd y;
};

Ritz ritz_of(const MatrixXd& h) {
  const SymmetricEigen eigen(0.5 * (h + h.transpose()));
  return {eigen.values(), eigen.leading_vectors(h.rows())};
}

}  // namespace

bool SparseFactor::factorise(const SparseMatrix& k) {
  ldlt_.analyzePattern(k);
  const double entries = ldlt_.n_entries();
  if (entries > kMostFactorEntries) {
    std::ostringstream text;
    text << "the factor of the stiffness matrix would have " << entries << " entries, more than " << kMostFactorEntries
         << "; export a condensed model or a coarser mesh";
    throw std::invalid_argument(text.str());
  }
  ldlt_.factorize(k);
  if (ldlt_.info() != Eigen::Success) return false;
  const VectorXd pivot = ldlt_.vectorD(), diagonal = ldlt_.permutationP() * VectorXd(k.diagonal());
  for (Index i = 0; i < pivot.size(); ++i) {
    if (!(pivot(i) > 1e-13 * diagonal(i))) return false;
  }
  return true;
}

SparseFactor::SparseFactor(const SparseMatrix& k, const SparseMatrix& m) {
  const VectorXd stiff = k.diagonal(), heavy = m.diagonal();
  double least = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < stiff.size(); ++i) {
    if (!(stiff(i) > 0.0)) {
      std::ostringstream text;
      text << "degree of freedom " << i + 1 << " has the stiffness " << stiff(i)
           << "; each needs a positive diagonal element: leave free or fixed degrees of freedom out of the export";
      throw std::invalid_argument(text.str());
    }
    if (heavy(i) > 0.0) least = std::min(least, stiff(i) / heavy(i));
  }
  if (!std::isfinite(least)) throw std::invalid_argument("the mass matrix has no positive diagonal element");
  if (factorise(k)) return;
  shift_ = 1e-3 * least;
  if (!factorise(k + shift_ * m))
    throw std::invalid_argument(
        "the stiffness matrix is neither positive definite nor that of a free body with mass: a part without mass "
        "moves "
        "freely, or signs are wrong; check supports and the order of the two files");
}

SparseModes lowest_modes(const SparseFactor& factor, const SparseMatrix& m, std::size_t n_modes) {
  MatrixXd basis(m.rows(), 0), h;
  MatrixXd block = new_directions(basis, factor.solve(first_block(m.rows())), m);
  MatrixXd images(m.rows(), 0);  // (K + shift M)^-1 M basis
  Ritz ritz;
  const auto n = std::min(static_cast<Index>(n_modes), m.rows());
  for (int i = 0; i < kMostBlocks && block.cols() > 0; ++i) {
    const MatrixXd image = factor.solve(m * block);
    const Index before = basis.cols();
    basis.conservativeResize(Eigen::NoChange, before + block.cols());
    basis.rightCols(block.cols()) = block;
    images.conservativeResize(Eigen::NoChange, before + block.cols());
    images.rightCols(block.cols()) = image;
    h.conservativeResize(basis.cols(), basis.cols());
    const MatrixXd cross = basis.transpose() * (m * image);
    h.rightCols(block.cols()) = cross;
    h.bottomRows(block.cols()) = cross.transpose();
    ritz = ritz_of(h);
    block = new_directions(basis, image, m);
    if (basis.cols() < n + 2 * kBlock && block.cols() > 0) continue;
    double worst = 0.0;
    for (Index r = 0; r < std::min(n, basis.cols()); ++r) {
      const VectorXd off = images * ritz.y.col(r) - ritz.mu(r) * (basis * ritz.y.col(r));
      worst = std::max(worst, std::sqrt(std::max(off.dot(m * off), 0.0)) / ritz.mu(r));
    }
    if (worst < std::sqrt(kConverged)) break;  // errors of eigenvalues go with the square of the residual
  }
  SparseModes out;
  const Index found = std::min(n, basis.cols());
  out.lambda.resize(found);
  out.x.resize(m.rows(), found);
  for (Index r = 0; r < found; ++r) {
    out.lambda(r) = 1.0 / ritz.mu(r) - factor.shift();
    out.x.col(r) = images * ritz.y.col(r) / ritz.mu(r);  // one more power step: exact zero error where there is no mass
    out.x.col(r) /= std::sqrt(out.x.col(r).dot(m * out.x.col(r)));
  }
  return out;
}

}  // namespace core::structure
