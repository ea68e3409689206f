#pragma once

#include <Eigen/Core>

#include "core/linear/dense.h"

namespace core::closure {

// a b, bit-identical on every machine (add_product()).
[[nodiscard]] inline Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(a.rows(), b.cols());
  add_product(out, 1.0, a, b);
  return out;
}

}  // namespace core::closure
