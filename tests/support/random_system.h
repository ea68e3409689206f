#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include "core/identification/correlation.h"

namespace test_support {

// Correlations of the outputs y = C x of x' = A x + w with the state covariance P.
inline core::Correlations exact_correlations(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C,
                                             const Eigen::MatrixXd& P, int max_lag) {
  const auto n = static_cast<int>(C.rows());
  core::Correlations out(n, max_lag);
  Eigen::MatrixXd power = Eigen::MatrixXd::Identity(A.rows(), A.cols());
  for (int lag = 0; lag <= max_lag; ++lag) {
    const Eigen::MatrixXd R = C * power * P * C.transpose();  // E[y(t + lag) y(t)']
    for (int i = 0; i < n; ++i) {
      for (int j = i; j < n; ++j) {
        out.set(i, j, lag, R(i, j), R(i, j));
        out.set(i, j, -lag, R(j, i), R(j, i));
      }
    }
    power *= A;
  }
  return out;
}

// A stable linear system driven by white noise, with the exact correlations of its outputs: x' = A x + w, y = C x.
// One complex pole pair per mode; shapes are complex and random.
struct RandomSystem {
  struct Pole {
    std::complex<double> lambda;              // discrete, upper half plane
    std::vector<std::complex<double>> shape;  // per channel
  };

  std::vector<Pole> poles;  // by rising frequency
  Eigen::MatrixXd A, C, P;  // P: state covariance

  RandomSystem(unsigned seed, int n_modes, int n_channels) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::normal_distribution<double> gaussian;
    const int n = 2 * n_modes;
    A = Eigen::MatrixXd::Zero(n, n);
    C = Eigen::MatrixXd(n_channels, n);
    for (int m = 0; m < n_modes; ++m) {
      // Spread over the band with distance between neighbours; damping 0.3 .. 5 %.
      const double turn = 2.0 * std::numbers::pi * (0.04 + 0.42 * (m + 0.2 + 0.6 * unit(random)) / n_modes);
      const double zeta = 0.003 + 0.047 * unit(random);
      const std::complex<double> lambda = std::exp(std::complex<double>(-zeta, std::sqrt(1.0 - zeta * zeta)) * turn);
      A.block<2, 2>(2 * m, 2 * m) << lambda.real(), lambda.imag(), -lambda.imag(), lambda.real();
      poles.push_back({lambda, {}});
    }
    for (Eigen::Index i = 0; i < C.size(); ++i) C.data()[i] = gaussian(random);
    for (int m = 0; m < n_modes; ++m) {
      // Eigenvector of the 2 x 2 block for lambda: (1, i).
      for (int c = 0; c < n_channels; ++c) {
        poles[static_cast<std::size_t>(m)].shape.push_back(C(c, 2 * m) +
                                                           std::complex<double>(0.0, 1.0) * C(c, 2 * m + 1));
      }
    }
    P = stationary_covariance(random);
  }

  [[nodiscard]] core::Correlations correlations(int max_lag) const { return exact_correlations(A, C, P, max_lag); }

 private:
  // P = A P A' + Q by doubling; Q random and positive definite.
  [[nodiscard]] Eigen::MatrixXd stationary_covariance(std::mt19937& random) const {
    std::normal_distribution<double> gaussian;
    Eigen::MatrixXd B(A.rows(), A.cols());
    for (Eigen::Index i = 0; i < B.size(); ++i) B.data()[i] = gaussian(random);
    Eigen::MatrixXd covariance = B * B.transpose() + 0.1 * Eigen::MatrixXd::Identity(A.rows(), A.cols());
    Eigen::MatrixXd step = A;
    for (int k = 0; k < 16; ++k) {
      covariance += step * covariance * step.transpose();
      step *= step;
    }
    return covariance;
  }
};

}  // namespace test_support
