#pragma once

#include <Eigen/Core>

namespace core {

// Products and triangular factors of dense matrices, bit-identical on every machine: each element is a sum in the order
// of the inner index, whatever the machine's vector width. They may allocate.

// c += factor * a * b.
void add_product(Eigen::Ref<Eigen::MatrixXd> c, double factor, const Eigen::Ref<const Eigen::MatrixXd>& a,
                 const Eigen::Ref<const Eigen::MatrixXd>& b);

// c += factor * a * b^T.
void add_product_transposed(Eigen::Ref<Eigen::MatrixXd> c, double factor, const Eigen::Ref<const Eigen::MatrixXd>& a,
                            const Eigen::Ref<const Eigen::MatrixXd>& b);

// a * a^T; only one half is computed.
[[nodiscard]] Eigen::MatrixXd gram(const Eigen::Ref<const Eigen::MatrixXd>& a);

// Input m = [T; B], T symmetric n x n, lower triangle read. Result [L; B L^-T] with T = L L^T; the strict upper
// triangle of T is set to zero. False if T is not positive definite; m is then undefined.
[[nodiscard]] bool factor_stacked(Eigen::MatrixXd& m);

// x <- x L^-1, L lower triangular.
void divide_by_lower(Eigen::Ref<Eigen::MatrixXd> x, const Eigen::Ref<const Eigen::MatrixXd>& lower);

}  // namespace core
