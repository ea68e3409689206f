#pragma once

#include <Eigen/Core>

namespace core {

// All eigenvalues, and the requested number of leading eigenvectors, of a symmetric matrix: Householder tridiagonal
// form, Pal-Walker-Kahan QL, inverse iteration (Parlett, The Symmetric Eigenvalue Problem, 1998). Bit-identical on
// every machine.
class SymmetricEigen {
 public:
  explicit SymmetricEigen(Eigen::MatrixXd a);  // n x n, lower triangle read; finite

  [[nodiscard]] const Eigen::VectorXd& values() const noexcept { return values_; }  // descending

  // n x count, orthonormal. Inverse iteration cannot separate eigenvalues merged by rounding; the whole decomposition
  // by implicit QR is used if the vectors are not orthogonal.
  [[nodiscard]] Eigen::MatrixXd leading_vectors(Eigen::Index count) const;

 private:
  void reduce();

  Eigen::MatrixXd reflectors_;  // column k: Householder vector of step k below the diagonal, its first element 1
  Eigen::VectorXd tau_, diagonal_, subdiagonal_, values_;
};

}  // namespace core
