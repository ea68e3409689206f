#pragma once

#include <Eigen/Core>

namespace core {

// Functions for the symmetric tridiagonal matrix with this diagonal (n) and subdiagonal (n - 1).

// Eigenvalues, descending, by the root-free QL of Pal, Walker and Kahan (Parlett 1998, section 8.14).
[[nodiscard]] Eigen::VectorXd tridiagonal_values(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& subdiagonal);

// Eigenvectors of the leading `count` of `values` (descending), as rows: count x n. Inverse iteration; vectors of
// values closer than 1e-6 of the largest are orthogonalised.
[[nodiscard]] Eigen::MatrixXd tridiagonal_vectors(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& subdiagonal,
                                                  const Eigen::VectorXd& values, Eigen::Index count);

}  // namespace core
