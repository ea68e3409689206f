// Poles of the predictor, and what the prediction does where they move.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "core/closure/response/channel_predictor.h"

namespace core::closure {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

constexpr double kHighShare = 0.36;  // of the rate; above, folded modes cannot be told
constexpr double kMostDamping = 0.06;
constexpr double kStep = 1e-5;

bool moves(const Complex& pole) {
  const Complex s = std::log(pole);  // per sample
  const double turn = std::abs(s.imag()) / (2.0 * std::numbers::pi);
  return turn > 0.01 && turn < kHighShare && -s.real() < kMostDamping * std::abs(s) && std::abs(pole) < 1.02;
}

MatrixXd companion_of(const MatrixXd& coefficients, Index n, Index order) {
  MatrixXd out = MatrixXd::Zero(n * order, n * order);
  for (Index i = 0; i < order; ++i) out.block(0, i * n, n, n) = coefficients.middleRows(1 + i * n, n).transpose();
  if (order > 1) out.bottomLeftCorner(n * (order - 1), n * (order - 1)).setIdentity();
  return out;
}

// ln of the poles that move, one of each pair.
std::vector<Complex> modes_of(const MatrixXd& coefficients, Index n, Index order, bool all) {
  std::vector<Complex> out;
  const Eigen::EigenSolver<MatrixXd> solver(companion_of(coefficients, n, order), false);
  if (solver.info() != Eigen::Success) return out;
  for (const Complex& pole : solver.eigenvalues()) {
    if (pole.imag() > 0.0 && (all ? std::abs(pole) > 0.5 : moves(pole))) out.push_back(std::log(pole));
  }
  return out;
}

// Of the plain samples that `takes`.
template <class Takes>
MatrixXd fit_rows(const ChannelRecord& scaled, const ChannelPredictor& predictor, Takes takes) {
  std::vector<Index> rows;
  for (Index k = 0; k < scaled.n_samples(); ++k) {
    if (predictor.plain[static_cast<std::size_t>(k)] != 0 && takes(k)) rows.push_back(k);
  }
  if (static_cast<Index>(rows.size()) < 3 * predictor.regressors.cols()) return {};
  const MatrixXd z = predictor.regressors(rows, Eigen::all), y = scaled.value(rows, Eigen::all);
  MatrixXd gram = z.transpose() * z;
  gram.diagonal() *= 1.0 + 1e-9;
  return gram.ldlt().solve(z.transpose() * y);
}

// The imaginary part of the nearest within 6 %; 0 = none.
double nearest(const std::vector<Complex>& modes, double turn) {
  double best = 0.06 * turn, found = 0.0;
  for (const Complex& mode : modes) {
    if (std::abs(mode.imag() - turn) < best) best = std::abs(mode.imag() - turn), found = mode.imag();
  }
  return found;
}

}  // namespace

// Companion form: eigenvectors are (l^(p-1) v; ...; v). With the same v and other eigenvalues the top block row is
// V_top L V^-1.
MatrixXd frequency_derivative(const ChannelPredictor& predictor, double /*rate_hz*/) {
  const Index n = predictor.n_channels, size = n * predictor.order;
  const MatrixXd companion = companion_of(predictor.whole, n, predictor.order);
  const Eigen::EigenSolver<MatrixXd> solver(companion);
  if (solver.info() != Eigen::Success) return {};
  Eigen::VectorXcd poles = solver.eigenvalues();
  const MatrixXcd shapes = solver.eigenvectors().bottomRows(n);  // v
  bool any = false;
  for (Complex& pole : poles) {
    if (std::abs(pole) < 1e-9) return {};
    if (!moves(pole)) continue;
    pole = std::polar(std::abs(pole), std::arg(pole) * (1.0 + kStep));
    any = true;
  }
  if (!any) return {};
  MatrixXcd vectors(size, size);
  for (Index i = 0; i < predictor.order; ++i) {
    for (Index c = 0; c < size; ++c)
      vectors.block(i * n, c, n, 1) = shapes.col(c) * std::pow(poles(c), static_cast<double>(predictor.order - 1 - i));
  }
  const MatrixXcd top = vectors.topRows(n) * poles.asDiagonal();
  const MatrixXcd moved = vectors.transpose().partialPivLu().solve(top.transpose()).transpose();
  MatrixXd out = (moved.real() - companion.topRows(n)) / kStep;
  return out.allFinite() ? out : MatrixXd();
}

double frequency_change(const ChannelRecord& scaled, const ChannelPredictor& predictor, const Eigen::VectorXd& course,
                        Index without) {
  const Index n = predictor.n_channels;
  const auto takes_part = [&](Index k) {
    return predictor.plain[static_cast<std::size_t>(k)] != 0 && predictor.part_of(k) != without;
  };
  std::vector<double> seen;
  for (Index k = 0; k < course.size(); ++k) {
    if (takes_part(k)) seen.push_back(course(k));
  }
  if (seen.empty()) return 0.0;
  const auto middle = seen.begin() + static_cast<std::ptrdiff_t>(seen.size() / 2);
  std::nth_element(seen.begin(), middle, seen.end());
  const double median = *middle;
  double sum[2] = {}, count[2] = {};
  for (Index k = 0; k < course.size(); ++k) {
    if (!takes_part(k)) continue;
    const int side = course(k) >= median ? 1 : 0;
    sum[side] += course(k), count[side] += 1.0;
  }
  const MatrixXd low = fit_rows(scaled, predictor, [&](Index k) { return takes_part(k) && course(k) < median; });
  const MatrixXd high = fit_rows(scaled, predictor, [&](Index k) { return takes_part(k) && course(k) >= median; });
  if (low.size() == 0 || high.size() == 0) return 0.0;
  const double span = sum[1] / count[1] - sum[0] / count[0];
  const auto modes_low = modes_of(low, n, predictor.order, true), modes_high = modes_of(high, n, predictor.order, true);
  double weighted = 0.0, weights = 0.0;
  for (const Complex& mode : modes_of(predictor.whole, n, predictor.order, false)) {
    const double a = nearest(modes_low, mode.imag()), b = nearest(modes_high, mode.imag());
    if (a <= 0.0 || b <= 0.0) continue;
    const double weight = mode.imag() * mode.imag() / std::max(-mode.real(), 1e-4 * mode.imag());
    weighted += weight * (b - a) / mode.imag();
    weights += weight;
  }
  return weights > 0.0 && span > 0.0 ? weighted / weights / span : 0.0;
}

}  // namespace core::closure
