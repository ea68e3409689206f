#pragma once

#include <Eigen/Core>
#include <optional>

namespace core::structure {

// K x = lambda M x with K symmetric, positive semidefinite or indefinite by axial compression, M positive semidefinite.
// Pairs as eigenvalues mu of (K + shift M)^-1 M: lambda = 1 / mu - shift. The lowest lambda are the most accurate,
// whatever the highest are, and massless degrees of freedom (mu = 0) are allowed.
struct DensePairs {
  double shift = 0.0;  // 0 unless K is singular
  Eigen::VectorXd mu;  // descending
  Eigen::MatrixXd x;   // dof x n_vectors; x' (K + shift M) x = 1
};

// Empty if K + shift M is not positive definite: the structure has no stiffness left, or a part without mass moves
// freely.
// n_vectors: how many columns of x are needed, of the lowest lambda.
[[nodiscard]] std::optional<DensePairs> dense_pairs(const Eigen::MatrixXd& k, const Eigen::MatrixXd& m,
                                                    Eigen::Index n_vectors);

}  // namespace core::structure
