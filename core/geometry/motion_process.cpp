#include "core/geometry/motion_process.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace core {

MotionProcess::MotionProcess(double corner_hz) : lambda_(2.0 * std::numbers::pi * corner_hz) {
  const double k = lambda_ * lambda_ / 3.0;
  stationary_ << 1.0, 0.0, -k, 0.0, k, 0.0, -k, 0.0, 9.0 * k * k;
}

void MotionProcess::start(const MotionVector& sd) noexcept {
  mean_.setZero();
  covariance_.setZero();
  for (int i = 0; i < kMotionSize; ++i) {
    covariance_(kMotionSize + i, kMotionSize + i) = sd(i) * sd(i) * stationary_(1, 1);
    covariance_(2 * kMotionSize + i, 2 * kMotionSize + i) = sd(i) * sd(i) * stationary_(2, 2);
  }
  factor();
}

// exp(A dt) for the companion matrix A of (s + lambda)^3: (A + lambda I)^3 = 0, so the series is finite.
MotionProcess::Matrix3 MotionProcess::transition(double dt_s) const noexcept {
  const double l = lambda_;
  Matrix3 n;
  n << l, 1.0, 0.0, 0.0, l, 1.0, -l * l * l, -3.0 * l * l, -2.0 * l;
  return std::exp(-l * dt_s) * (Matrix3::Identity() + n * dt_s + n * n * (0.5 * dt_s * dt_s));
}

// Integral of q phi phi^T, phi the response to white noise of density q = 16/3 lambda^5; by Gauss-Legendre quadrature
// for short steps, where P - F P F^T would lose all significant digits.
MotionProcess::Matrix3 MotionProcess::process_noise(double dt_s, const Matrix3& transition) const noexcept {
  constexpr double kShort = 0.5;
  const double l = lambda_;
  if (l * dt_s > kShort) return stationary_ - transition * stationary_ * transition.transpose();
  constexpr std::array<double, 5> kNode{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                        0.9061798459386640};
  constexpr std::array<double, 5> kWeight{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                          0.4786286704993665, 0.2369268850561891};
  Matrix3 noise = Matrix3::Zero();
  for (std::size_t k = 0; k < kNode.size(); ++k) {
    const double s = 0.5 * dt_s * (1.0 + kNode[k]);
    const Eigen::Vector3d phi(0.5 * s * s, s - 0.5 * l * s * s, 1.0 - 2.0 * l * s + 0.5 * l * l * s * s);
    noise += (0.5 * dt_s * kWeight[k] * std::exp(-2.0 * l * s)) * (phi * phi.transpose());
  }
  return noise * (16.0 / 3.0 * std::pow(l, 5.0));
}

void MotionProcess::predict(double dt_s, const MotionVector& sd) noexcept {
  const double dt = std::max(0.0, dt_s);
  const Matrix3 f = transition(dt);
  const Matrix3 q = process_noise(dt, f);
  MotionStateVector mean = MotionStateVector::Zero();
  half_.setZero();
  work_.setZero();
  constexpr int n = kMotionSize;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      mean.segment<n>(a * n) += f(a, b) * mean_.segment<n>(b * n);
      half_.middleRows<n>(a * n) += f(a, b) * covariance_.middleRows<n>(b * n);
    }
  }
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) work_.middleCols<n>(a * n) += f(a, b) * half_.middleCols<n>(b * n);
  }
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      for (int i = 0; i < n; ++i) work_(a * n + i, b * n + i) += q(a, b) * sd(i) * sd(i);
    }
  }
  mean_ = mean;
  covariance_ = 0.5 * (work_ + work_.transpose());
  factor();
}

// Lower triangle with root root^T = covariance; a direction without variance has a column of zeros.
void MotionProcess::factor() noexcept {
  constexpr double kNothing = 1e-13;
  root_.setZero();
  for (int j = 0; j < kMotionState; ++j) {
    double pivot = covariance_(j, j);
    for (int k = 0; k < j; ++k) pivot -= root_(j, k) * root_(j, k);
    if (!(pivot > kNothing * covariance_(j, j))) continue;
    const double d = std::sqrt(pivot);
    root_(j, j) = d;
    for (int i = j + 1; i < kMotionState; ++i) {
      double sum = covariance_(i, j);
      for (int k = 0; k < j; ++k) sum -= root_(i, k) * root_(j, k);
      root_(i, j) = sum / d;
    }
  }
}

// With P = root root^T and L its rows of the components: step = root_left (I + L^T information L)^-1 L^T rhs.
bool MotionProcess::step(const MotionMatrix& information, const MotionVector& rhs, MotionStateVector& step) noexcept {
  constexpr int n = kMotionSize;
  const MotionMatrix l = root_.topLeftCorner<n, n>();
  inner_.noalias() = l.transpose() * (information * l);
  inner_.diagonal().array() += 1.0;
  Eigen::LLT<Eigen::Ref<MotionMatrix>> solver(inner_);
  if (solver.info() != Eigen::Success) return false;
  MotionVector y = l.transpose() * rhs;
  solver.solveInPlace(y);
  step.noalias() = root_.leftCols<n>() * y;
  return step.allFinite();
}

void MotionProcess::accept(const MotionStateVector& step) noexcept {
  constexpr int n = kMotionSize;
  mean_ += step;
  work_ = root_.transpose();
  auto top = work_.topRows<n>();
  inner_.triangularView<Eigen::Lower>().solveInPlace(top);
  covariance_.noalias() = work_.transpose() * work_;
}

MotionVector MotionProcess::at(const MotionStateVector& state, double tau_s) noexcept {
  constexpr int n = kMotionSize;
  return state.head<n>() + tau_s * state.segment<n>(n) + (0.5 * tau_s * tau_s) * state.tail<n>();
}

}  // namespace core
