#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace core {

// Eigenvalues of a real matrix in the upper half plane, and the observed components of their eigenvectors.
struct UpperEigen {
  std::vector<std::complex<double>> values;
  Eigen::MatrixXcd seen;  // rows of c x values: c times the eigenvector of unit norm
};

// a: n x n, finite; c: any number of rows x n. Hessenberg form by reflections, Francis' double-shift QR without
// vectors, one inverse iteration per eigenvalue (Golub & Van Loan 2013, sections 7.4-7.6). False if QR does not
// converge.
[[nodiscard]] bool upper_half_plane_eigen(const Eigen::Ref<const Eigen::MatrixXd>& a,
                                          const Eigen::Ref<const Eigen::MatrixXd>& c, UpperEigen& out);

}  // namespace core
