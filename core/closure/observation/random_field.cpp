#include "core/closure/observation/random_field.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/closure/observation/product.h"
#include "core/linear/dense.h"

namespace core::closure {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double kLeastOwn = 1e-9;  // of a component's variance beside the largest
constexpr int kSteps = 60, kDecades = 8;

MatrixXd unit_covariance(const PointGeometry& geometry, double length_px) {
  const Index n = geometry.x.size();
  MatrixXd out = MatrixXd::Zero(2 * n, 2 * n);
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) {
      const double apart_px =
          geometry.alpha_px * std::hypot(geometry.x(i) - geometry.x(j), geometry.y(i) - geometry.y(j));
      out(2 * i, 2 * j) = out(2 * i + 1, 2 * j + 1) = std::exp(-apart_px / length_px);
    }
  }
  return out;
}

// Orthonormal columns beside those of q.
MatrixXd complement(const MatrixXd& q) {
  const Eigen::HouseholderQR<MatrixXd> qr(q);
  const MatrixXd all = qr.householderQ() * MatrixXd::Identity(q.rows(), q.rows());
  return all.rightCols(q.rows() - q.cols());
}

// Squares along each column of `of`.
VectorXd squares_along(const MatrixXd& of, const MatrixXd& moments) {
  return product(moments, of).cwiseProduct(of).colwise().sum().transpose();
}

}  // namespace

double FieldSize::rms_px() const {
  double sum = 0.0;
  for (const double variance : variance_px2) sum += variance;
  return std::sqrt(sum);
}

RandomField::RandomField(const FitView& fit) : fit_(fit), above_(fit.model.q_high()) {
  const PointMotionModel& model = fit.model;
  const bool has_own_band = model.q_low().cols() > model.q_high().cols();
  const MatrixXd beside_above = complement(model.q_high());
  const MatrixXd beside_within = has_own_band ? complement(model.q_low()) : MatrixXd();
  if (has_own_band) within_.emplace(model.q_low());
  const auto components_of = [](const MatrixXd& beside, const MatrixXd& covariance) {
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(beside.transpose() * covariance * beside);
    const double least = kLeastOwn * eigen.eigenvalues().maxCoeff();
    return Components{beside * eigen.eigenvectors(), eigen.eigenvalues().cwiseMax(least)};
  };
  double length_px = kShortest_px;
  for (std::size_t i = 0; i < kOctaves; ++i, length_px *= 2.0) {
    const MatrixXd whitened = covariance(length_px);
    OfLength one{length_px, components_of(beside_above, whitened), {}};
    if (has_own_band) one.within = components_of(beside_within, whitened);
    lengths_.push_back(std::move(one));
  }
}

MatrixXd RandomField::covariance(double length_px) const {
  const MatrixXd half = fit_.model.whitened(unit_covariance(fit_.model.geometry(), length_px));
  return fit_.model.whitened<MatrixXd>(half.transpose());
}

const RandomField::Components& RandomField::components(const OfLength& of, std::size_t rung) const {
  return is_within(rung) ? *of.within : of.above;
}

double RandomField::share_of(std::size_t rung) const { return fit_.held_out.share_of(RungSet{1} << rung); }

double RandomField::variance_in(std::size_t rung, const FieldSize& size) const {
  return size.variance_px2[rung] / share_of(rung);
}

const RandomField::OfLength& RandomField::of(const FieldSize& size) const {
  for (const OfLength& length : lengths_) {
    if (length.length_px >= size.length_px) return length;
  }
  return lengths_.back();
}

// Likelihood of n values of each component: variance 1 + v own. The deviance is beside that of v = 0.
RandomField::Estimate RandomField::estimate(const VectorXd& own, const VectorXd& squares, double n) {
  const auto deviance = [&](double v) {
    const Eigen::ArrayXd one = 1.0 + v * own.array();
    return (n * one.log() + squares.array() / one - squares.array()).sum();
  };
  Estimate out;
  const double top = 100.0 * (squares / n).maxCoeff() / own.maxCoeff();
  double best = -kDecades;
  for (int half = -2 * kDecades; half <= 0; ++half) {
    const double power = 0.5 * half;
    if (deviance(top * std::pow(10.0, power)) < deviance(top * std::pow(10.0, best))) best = power;
  }
  double low = best - 0.5, high = best + 0.5;
  for (int step = 0; step < kSteps; ++step) {
    const double third = (high - low) / 3.0;
    if (deviance(top * std::pow(10.0, low + third)) < deviance(top * std::pow(10.0, high - third))) {
      high -= third;
    } else {
      low += third;
    }
  }
  const double v = top * std::pow(10.0, 0.5 * (low + high));
  if (!(deviance(v) < 0.0)) return out;
  out.variance = v, out.deviance = deviance(v);
  out.information = 0.5 * n * (own.array() / (1.0 + v * own.array())).square().sum();
  return out;
}

// By all rungs together.
std::size_t RandomField::best_length(const ResidualMoments& moments, FieldSize& size) const {
  std::vector<double> deviance;
  const auto n = static_cast<double>(fit_.record.n_frames());
  for (const OfLength& length : lengths_) {
    const VectorXd squares = squares_along(length.above.direction, moments.all_sum);
    deviance.push_back(estimate(length.above.variance, squares, n).deviance);
  }
  const auto best = static_cast<std::size_t>(std::min_element(deviance.begin(), deviance.end()) - deviance.begin());
  size.length_px = lengths_[best].length_px;
  // Curvature over the logarithm; at an end of the grid the length is known to an octave at best.
  const bool inside = best > 0 && best + 1 < deviance.size();
  const double bend = inside ? deviance[best - 1] + deviance[best + 1] - 2.0 * deviance[best] : 0.0;
  const double octave = std::log(2.0), grid = octave / std::sqrt(12.0);
  size.length_factor_sigma = bend > 0.0 ? std::hypot(octave * std::sqrt(2.0 / bend), grid) : octave;
  return best;
}

FieldSize RandomField::size(const ResidualMoments& moments) const {
  FieldSize out;
  const OfLength& length = lengths_[best_length(moments, out)];
  double variance_of_sum = 0.0;
  for (std::size_t rung = 0; rung < moments.of_rung.size(); ++rung) {
    const Components& own = components(length, rung);
    const MatrixXd& m = moments.of_rung[rung];
    const double n = fit_.held_out.freedom_in(rung), share = share_of(rung);
    const Estimate found = estimate(own.variance, squares_along(own.direction, m), n);
    out.variance_px2.push_back(0.0);
    if (found.variance <= 0.0) continue;
    const VectorXd kept = (1.0 + found.variance * own.variance.array()).inverse();
    const MatrixXd p = gram(own.direction * kept.cwiseSqrt().asDiagonal());
    const LeaveOnePointOut& left_out = is_within(rung) ? *within_ : above_;
    const double gain = left_out.squares(m) - left_out.squares_under(p, m);
    const double taken = static_cast<double>(kept.size()) - kept.sum();
    if (!(gain > kRungSigmas * std::sqrt(2.0 * n * taken))) continue;
    out.variance_px2.back() = found.variance * share;
    out.gain += gain;
    variance_of_sum += share * share / found.information;
  }
  if (out.gain > 0.0) out.rms_sigma_px = 0.5 * std::sqrt(variance_of_sum) / out.rms_px();
  return out;
}

double RandomField::n_patterns(const FieldSize& size, const ResidualMoments& moments) const {
  const OfLength& length = of(size);
  double n = 0.0;
  MatrixXd sum = MatrixXd::Zero(moments.all_sum.rows(), moments.all_sum.cols());
  for (std::size_t rung = 0; rung < size.variance_px2.size(); ++rung) {
    if (size.variance_px2[rung] > 0.0) sum += moments.of_rung[rung], n += fit_.held_out.freedom_in(rung);
  }
  const MatrixXd& u = length.above.direction;
  MatrixXd beyond = u.transpose() * sum * u;
  beyond.diagonal().array() -= n;
  const auto m = static_cast<double>(beyond.rows());
  const double squares = beyond.squaredNorm() - n * m * (m + 1.0);  // less those of noise
  const double trace = beyond.trace();
  return squares > 0.0 ? trace * trace / squares : m;
}

MatrixXd RandomField::predicted(const FieldSize& size, const MatrixXd& series) const {
  const OfLength& length = of(size);
  const MatrixXd of_length = covariance(length.length_px);
  const Rungs& rungs = fit_.held_out.rungs();
  MatrixXd out = MatrixXd::Zero(series.rows(), series.cols());
  for (std::size_t rung = 0; rung < size.variance_px2.size(); ++rung) {
    if (!(size.variance_px2[rung] > 0.0)) continue;
    const Components& own = components(length, rung);
    const double v = variance_in(rung, size);
    const VectorXd share = v / (1.0 + v * own.variance.array());
    const MatrixXd onto = of_length * own.direction * share.asDiagonal();
    const std::vector<Index> orders = rungs.orders(series.cols(), RungSet{1} << rung);
    Rungs::for_cosines(series.cols(), orders, [&](Index /*first*/, const MatrixXd& cosines) {
      out.noalias() += (onto * (own.direction.transpose() * (series * cosines))) * cosines.transpose();
    });
  }
  return out;
}

double RandomField::freedom(const FieldSize& size) const {
  const OfLength& length = of(size);
  double sum = 0.0;
  for (std::size_t rung = 0; rung < size.variance_px2.size(); ++rung) {
    if (!(size.variance_px2[rung] > 0.0)) continue;
    const Eigen::ArrayXd own = variance_in(rung, size) * components(length, rung).variance.array();
    sum += fit_.held_out.freedom_in(rung) * (own / (1.0 + own)).sum();
  }
  return sum;
}

}  // namespace core::closure
