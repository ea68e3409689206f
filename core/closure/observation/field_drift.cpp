#include "core/closure/observation/field_drift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace core::closure {
namespace {

using Eigen::Index, Eigen::MatrixXd;

constexpr std::array kLags_s{0.1, 0.2, 0.35, 0.5, 0.75, 1.0};
constexpr double kSlowest_px_s = 5.0, kSpeedStep = 1.35;
constexpr int kSpeeds = 16;  // up to 450 px/s
constexpr int kDirections = 20;
constexpr double kLongest_px = 240.0;  // of the lengths, each half as long as the next
constexpr std::size_t kLengths = 5;
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

// Pairs of points, each once, and what was measured of them at one lag.
struct PointPairs {
  std::vector<double> apart_u_px, apart_v_px;
};
struct PairsAtLag {
  double seconds;
  std::vector<double> antisymmetric;  // part of the covariances
};

// The covariances of a static field are symmetric, those of one that drifts are not. Cosine of the angle between the
// antisymmetric parts of the measured and the predicted ones, over all lags, for each length, the longest first: half
// the length squares the exponential.
std::array<double, kLengths> likeness(const PointPairs& pairs, const std::vector<PairsAtLag>& lags, double measured,
                                      double u_px_s, double v_px_s) {
  const auto decay = [](double u_px, double v_px) {
    return std::exp(-std::sqrt(u_px * u_px + v_px * v_px) / kLongest_px);
  };
  std::array<double, kLengths> product{}, squares{}, out{};
  for (const PairsAtLag& lag : lags) {
    const double on_u = u_px_s * lag.seconds, on_v = v_px_s * lag.seconds;
    for (std::size_t p = 0; p < pairs.apart_u_px.size(); ++p) {
      const double du = pairs.apart_u_px[p], dv = pairs.apart_v_px[p];
      double with = decay(du - on_u, dv - on_v), against = decay(du + on_u, dv + on_v);
      for (std::size_t k = 0; k < kLengths; ++k, with *= with, against *= against) {
        const double predicted = with - against;
        product[k] += predicted * lag.antisymmetric[p], squares[k] += predicted * predicted;
      }
    }
  }
  for (std::size_t k = 0; k < kLengths; ++k)
    out[k] = measured > 0.0 && squares[k] > 0.0 ? product[k] / std::sqrt(squares[k] * measured) : 0.0;
  return out;
}

}  // namespace

FieldDrift field_drift(const MatrixXd& all_px, const PointGeometry& geometry, double rate_hz) {
  const Index step = (all_px.rows() / 2 + kMostPoints - 1) / kMostPoints, n = all_px.rows() / 2 / step;
  MatrixXd field_px(2 * n, all_px.cols());
  for (Index i = 0; i < n; ++i) field_px.middleRows(2 * i, 2) = all_px.middleRows(2 * i * step, 2);
  PointPairs pairs;
  const auto n_pairs = static_cast<std::size_t>(n * (n - 1) / 2);
  pairs.apart_u_px.reserve(n_pairs), pairs.apart_v_px.reserve(n_pairs);
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < j; ++i) {
      pairs.apart_u_px.push_back(geometry.alpha_px * (geometry.x(i * step) - geometry.x(j * step)));
      pairs.apart_v_px.push_back(geometry.alpha_px * (geometry.y(i * step) - geometry.y(j * step)));
    }
  }
  std::vector<PairsAtLag> lags;
  const double all = field_px.squaredNorm();
  double measured = 0.0;
  for (const double wanted_s : kLags_s) {
    const auto lag = std::max<Index>(1, std::lround(wanted_s * rate_hz));
    if (lag >= field_px.cols() || !(all > 0.0)) continue;
    const MatrixXd products = lagged(field_px, lag) / all;
    PairsAtLag at{static_cast<double>(lag) / rate_hz, {}};
    at.antisymmetric.reserve(n_pairs);
    for (Index j = 0; j < n; ++j)
      for (Index i = 0; i < j; ++i) at.antisymmetric.push_back(products(i, j) - products(j, i));
    for (const double value : at.antisymmetric) measured += value * value;
    lags.push_back(std::move(at));
  }
  FieldDrift best;
  const auto compare = [&](double now, double speed, double angle) {
    if (!(now > best.likeness)) return;
    best.likeness = now, best.u_px_s = speed * std::cos(angle), best.v_px_s = speed * std::sin(angle);
    best.sigma_px_s = 0.5 * speed * std::max(kSpeedStep - 1.0, 2.0 * std::numbers::pi / kDirections);
  };
  for (int i = 0; i < kSpeeds; ++i) {
    const double speed = kSlowest_px_s * std::pow(kSpeedStep, i);
    for (int k = 0; k < kDirections / 2; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / kDirections;
      for (const double now : likeness(pairs, lags, measured, speed * std::cos(angle), speed * std::sin(angle))) {
        compare(now, speed, angle);
        compare(-now, speed, angle + std::numbers::pi);  // the opposite drift changes the sign
      }
    }
  }
  return best;
}

}  // namespace core::closure
