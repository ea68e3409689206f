#pragma once

#include <Eigen/SparseCholesky>
#include <cstddef>

#include "core/structure/affine_model.h"

namespace core::structure {

// Factor of a large sparse K, or of K + shift M where K is singular. Throws std::invalid_argument with the reason in
// words if K is not positive semidefinite, if neither is definite, or if the factor would exceed kMostFactorEntries.
class SparseFactor {
 public:
  static constexpr double kMostFactorEntries = 1.5e8;  // 12 bytes each: 1.8 GB

  SparseFactor(const SparseMatrix& k, const SparseMatrix& m);

  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const { return ldlt_.solve(right); }
  [[nodiscard]] double shift() const noexcept { return shift_; }

 private:
  bool factorise(const SparseMatrix& k);

  // Size of the factor after analyzePattern(), before it is allocated; Eigen has no public function for it.
  struct Ldlt : Eigen::SimplicialLDLT<SparseMatrix> {
    [[nodiscard]] double n_entries() const { return m_nonZerosPerCol.cast<double>().sum(); }
  };
  Ldlt ldlt_;
  double shift_ = 0.0;
};

// The lowest modes of K x = lambda M x: block Krylov method with the factor as shift and inverse, full
// reorthogonalisation in the inner product of M, Rayleigh-Ritz (Parlett, The Symmetric Eigenvalue Problem, 1998, 13).
// Blocks find equal frequencies. Deterministic.
struct SparseModes {
  Eigen::VectorXd lambda;  // ascending; of rigid-body motion about 0
  Eigen::MatrixXd x;       // dof x modes; modal mass 1
};
[[nodiscard]] SparseModes lowest_modes(const SparseFactor& factor, const SparseMatrix& m, std::size_t n_modes);

}  // namespace core::structure
