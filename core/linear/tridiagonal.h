#pragma once

#include <Eigen/Core>

namespace core {

// Of the symmetric tridiagonal matrix with this diagonal (n) and subdiagonal (n - 1).

// Eigenvalues, descending. The root-free QL of Pal, Walker and Kahan (Parlett 1998, section 8.14).
[[nodiscard]] Eigen::VectorXd tridiagonal_values(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& subdiagonal);

// Eigenvectors of the leading `count` of `values` (descending), as rows: count x n. Inverse iteration; vectors of
// values closer than 1e-6 of the largest are made orthogonal.
[[nodiscard]] Eigen::MatrixXd tridiagonal_vectors(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& subdiagonal,
                                                  const Eigen::VectorXd& values, Eigen::Index count);

}  // namespace core
