#pragma once

#include <Eigen/Core>
#include <random>

namespace test_support {

inline Eigen::MatrixXd noise_matrix(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gaussian;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return gaussian(random); });
}

}  // namespace test_support
