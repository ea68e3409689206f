// Change of the prediction with the poles of the predictor.
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
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

constexpr double kHighShare = 0.36;  // share of the rate above which a mode may be aliased
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

}  // namespace

// Companion form: eigenvectors are (l^(p-1) v; ...; v). For the same v and other eigenvalues the top block row is V_top
// L V^-1.
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

}  // namespace core::closure
