#include "core/closure/observation/point_noise.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "core/closure/observation/row_spectra.h"
#include "core/linear/median.h"

namespace core::closure {
namespace {

constexpr double kLeastShareLeft = 0.05;       // of a point's variance that must be left to it
constexpr double kLeast = 0.2, kMost = 5.0;    // of the variance that the point's own residual shows
constexpr double kMedian = std::numbers::ln2;  // of an exponential distribution of mean 1

// Variance of each row, from the level of its spectrum.
Eigen::VectorXd levels(const Eigen::MatrixXd& residual, double rate_hz, double from_hz) {
  const int n_fft = row_fft_size(residual);
  const Eigen::MatrixXcd bins = row_spectra(residual, n_fft);
  const auto last = static_cast<int>(bins.cols()) - 1;
  const int first = std::clamp(static_cast<int>(std::ceil(from_hz * n_fft / rate_hz)), 1, last / 2);
  Eigen::VectorXd out(residual.rows());
  std::vector<double> power;
  for (Eigen::Index i = 0; i < residual.rows(); ++i) {
    power.clear();
    for (int b = first; b < last; ++b) power.push_back(std::norm(bins(i, b)));
    out(i) = median_in_place(power) / kMedian / static_cast<double>(residual.cols());
  }
  return out;
}

// Mean share of the noise variance of point k in the residual of point j.
Eigen::MatrixXd passed_on(const Eigen::MatrixXd& q) {
  const Eigen::Index n = q.rows() / 2;
  const Eigen::MatrixXd squares = (Eigen::MatrixXd::Identity(q.rows(), q.rows()) - q * q.transpose()).cwiseAbs2();
  Eigen::MatrixXd out(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index k = 0; k < n; ++k) out(j, k) = 0.5 * squares.block<2, 2>(2 * j, 2 * k).sum();
  }
  return out;
}

}  // namespace

Eigen::VectorXd point_noise(const Eigen::MatrixXd& residual, const Eigen::MatrixXd& q, double rate_hz, double from_hz) {
  const Eigen::VectorXd of_rows = levels(residual, rate_hz, from_hz);
  const Eigen::Index n = of_rows.size() / 2;
  Eigen::VectorXd left(n);
  for (Eigen::Index j = 0; j < n; ++j) left(j) = of_rows.segment<2>(2 * j).mean();
  Eigen::MatrixXd shares = passed_on(q);
  for (Eigen::Index j = 0; j < n; ++j) {
    if (shares(j, j) > kLeastShareLeft) continue;
    shares.row(j).setZero();
    shares(j, j) = left(j) = 1.0;
  }
  Eigen::VectorXd variance = shares.partialPivLu().solve(left);
  for (Eigen::Index j = 0; j < n; ++j) {
    const double own = left(j) / shares(j, j);
    variance(j) = own > 0.0 ? std::clamp(variance(j), kLeast * own, kMost * own) : 1.0;
  }
  return variance.cwiseSqrt();
}

}  // namespace core::closure
