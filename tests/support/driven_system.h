#pragma once

#include <Eigen/Dense>
#include <random>
#include <vector>

#include "core/identification/correlation.h"
#include "tests/support/random_system.h"

namespace test_support {

// A RandomSystem that a measured input drives beside white noise: channel 0 is the input, an oscillation that white
// noise keeps up, the others are the system's outputs. Exact correlations.
struct DrivenSystem {
  RandomSystem system;
  Eigen::MatrixXd A, C, P;  // of system and input together

  DrivenSystem(unsigned seed, int n_modes, int n_outputs) : system(seed, n_modes, n_outputs) {
    std::mt19937 random(seed + 1000);
    std::normal_distribution<double> gaussian;
    const Eigen::Index n = system.A.rows();
    A = Eigen::MatrixXd::Zero(n + 2, n + 2);
    A.topLeftCorner(n, n) = system.A;
    for (Eigen::Index i = 0; i < n; ++i) A(i, n) = 3.0 * gaussian(random);  // the input is state n
    const std::complex<double> lambda = std::polar(0.97, 0.9);
    A.bottomRightCorner(2, 2) << lambda.real(), lambda.imag(), -lambda.imag(), lambda.real();
    C = Eigen::MatrixXd::Zero(n_outputs + 1, n + 2);
    C(0, n) = 1.0;
    C.bottomLeftCorner(n_outputs, n) = system.C;
    P = Eigen::MatrixXd::Identity(n + 2, n + 2);
    Eigen::MatrixXd step = A;
    for (int k = 0; k < 16; ++k) {
      P += step * P * step.transpose();
      step *= step;
    }
  }

  [[nodiscard]] core::Correlations correlations(int max_lag) const { return exact_correlations(A, C, P, max_lag); }
};

}  // namespace test_support
