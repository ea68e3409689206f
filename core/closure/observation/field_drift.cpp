#include "core/closure/observation/field_drift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace core::closure {
namespace {

using Eigen::Index, Eigen::MatrixXd;

constexpr std::array kLags_s{0.1, 0.2, 0.35, 0.5, 0.75, 1.0};
constexpr double kSlowest_px_s = 5.0, kSpeedStep = 1.35;
constexpr int kSpeeds = 16;  // up to 450 px/s
constexpr int kDirections = 20;
constexpr std::array kLengths_px{15.0, 30.0, 60.0, 120.0, 240.0};
constexpr Index kMostPoints = 80;

// Sum over both axes of the products of each point's displacement with that of each other point `lag` frames before.
MatrixXd lagged(const MatrixXd& field, Index lag) {
  const Index n = field.rows() / 2, count = field.cols() - lag;
  MatrixXd out = MatrixXd::Zero(n, n);
  for (const Index axis : {0, 1}) {
    const auto rows = Eigen::seqN(axis, n, 2);
    const MatrixXd late = field(rows, Eigen::seqN(lag, count)), early = field(rows, Eigen::seqN(0, count));
    out += late * early.transpose();
  }
  return out;
}

}  // namespace

FieldDrift field_drift(const MatrixXd& all_px, const PointGeometry& geometry, double rate_hz) {
  const Index step = (all_px.rows() / 2 + kMostPoints - 1) / kMostPoints, n = all_px.rows() / 2 / step;
  MatrixXd field_px(2 * n, all_px.cols());
  Eigen::VectorXd u_px(n), v_px(n);
  for (Index i = 0; i < n; ++i) {
    field_px.middleRows(2 * i, 2) = all_px.middleRows(2 * i * step, 2);
    u_px(i) = geometry.alpha_px * geometry.x(i * step), v_px(i) = geometry.alpha_px * geometry.y(i * step);
  }
  struct Lag {
    double seconds;
    MatrixXd antisymmetric;  // part of the covariances
  };
  std::vector<Lag> lags;
  const double all = field_px.squaredNorm();
  double measured = 0.0;
  for (const double wanted_s : kLags_s) {
    const auto lag = std::max<Index>(1, std::lround(wanted_s * rate_hz));
    if (lag >= field_px.cols() || !(all > 0.0)) continue;
    const MatrixXd products = lagged(field_px, lag) / all;
    lags.push_back({static_cast<double>(lag) / rate_hz, products - products.transpose()});
    measured += 0.5 * lags.back().antisymmetric.squaredNorm();  // each pair once
  }
  // The covariances of a static field are symmetric, those of one that drifts are not. Cosine of the angle between the
  // antisymmetric parts of the measured and the predicted ones, over all lags.
  const auto likeness = [&](double length_px, double u_px_s, double v_px_s) {
    double product = 0.0, squares = 0.0;
    for (const Lag& lag : lags) {
      for (Index j = 0; j < n; ++j) {
        for (Index i = 0; i < j; ++i) {
          const double du = u_px(i) - u_px(j), dv = v_px(i) - v_px(j);
          const double on_u = u_px_s * lag.seconds, on_v = v_px_s * lag.seconds;
          const double predicted = std::exp(-std::hypot(du - on_u, dv - on_v) / length_px) -
                                   std::exp(-std::hypot(du + on_u, dv + on_v) / length_px);
          product += predicted * lag.antisymmetric(i, j), squares += predicted * predicted;
        }
      }
    }
    return measured > 0.0 && squares > 0.0 ? product / std::sqrt(squares * measured) : 0.0;
  };
  FieldDrift best;
  const auto compare = [&](double length_px, double speed, double angle) {
    const double u = speed * std::cos(angle), v = speed * std::sin(angle), now = likeness(length_px, u, v);
    if (!(now > best.likeness)) return;
    best.likeness = now, best.u_px_s = u, best.v_px_s = v;
    best.sigma_px_s = 0.5 * speed * std::max(kSpeedStep - 1.0, 2.0 * std::numbers::pi / kDirections);
  };
  for (const double length_px : kLengths_px) {
    for (int i = 0; i < kSpeeds; ++i) {
      const double speed = kSlowest_px_s * std::pow(kSpeedStep, i);
      for (int k = 0; k < kDirections; ++k) compare(length_px, speed, 2.0 * std::numbers::pi * k / kDirections);
    }
  }
  return best;
}

}  // namespace core::closure
