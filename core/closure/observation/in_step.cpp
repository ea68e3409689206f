#include "core/closure/observation/in_step.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/closure/observation/effects/rotation_patterns.h"

namespace core::closure {
namespace {

using Eigen::Index;

constexpr double kLeastSeen = 1e-3;  // of the squares of a combination of turns, in the residual

// Inverse of a normal matrix without the combinations that the residual hardly shows.
Eigen::Matrix3d inverse_of(const Eigen::Matrix3d& normal) {
  const Eigen::Vector3d scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scale.asDiagonal() * normal * scale.asDiagonal());
  const Eigen::Vector3d inverse =
      solver.eigenvalues().unaryExpr([](double value) { return value > kLeastSeen ? 1.0 / value : 0.0; });
  return scale.asDiagonal() * solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose() *
         scale.asDiagonal();
}

// The background's field of this motion, whitened.
Eigen::VectorXd field_of(const FitView& fit, Index motion) {
  const PointGeometry& g = fit.model.geometry();
  Eigen::VectorXd px = Eigen::VectorXd::Zero(2 * g.x.size());
  for (Index j = 0; j < g.x.size(); ++j) {
    if (makes_channel(fit.record.regions[fit.record.region_of_point[static_cast<std::size_t>(j)]].role)) continue;
    px.segment<2>(2 * j) = motion < 2 ? Eigen::Vector2d(Eigen::Vector2d::Unit(motion))
                                      : Eigen::Vector2d(g.alpha_px * g.x(j), g.alpha_px * g.y(j));
  }
  return fit.model.whitened(px);
}

}  // namespace

InStep in_step(const FitView& fit, Index motion, const Eigen::VectorXcd& spectrum, const TaperedSpectra& spectra,
               const std::vector<NoisyBand>& bands) {
  const PointMotionModel& model = fit.model;
  const Eigen::MatrixXd turns = model.whitened(rotation_patterns(model.geometry(), true));
  const Eigen::Vector3d per_turn = model.amplitudes_of(turns).row(model.first_background_row() + motion).transpose();
  const auto left_beside = [&](const Eigen::MatrixXd& q) -> Eigen::MatrixXd {
    return turns - q * (q.transpose() * turns);
  };
  const Eigen::MatrixXd outside = left_beside(model.q_high()), within = left_beside(model.q_low());
  const Eigen::MatrixXcd residual = tapered_spectra(model.residual(), fit.record.rate_hz).bins;
  const Rungs& rungs = fit.held_out.rungs();

  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero(), scatter = normal;
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  Eigen::VectorXd pattern = Eigen::VectorXd::Zero(residual.rows());
  double squares = 0.0, noise = 0.0;
  for (const NoisyBand& band : bands) {
    const double mean = spectrum.segment(band.first, band.last - band.first + 1).cwiseAbs2().mean();
    const double signal = std::max(mean - band.noise, 0.0), wiener = signal / mean;
    for (Index b = band.first; b <= band.last; ++b) {
      const bool has_added = holds(model.band(), rungs.of(spectra.bin_hz * static_cast<double>(b)));
      const Eigen::MatrixXd& left = has_added ? within : outside;
      const Eigen::Matrix3d of_turns = left.transpose() * left;
      const Eigen::VectorXd here = wiener * (residual.col(b) * std::conj(spectrum(b))).real();
      right += left.transpose() * here, pattern += here;
      normal += wiener * signal * of_turns, squares += wiener * signal;
      scatter += wiener * wiener * mean * of_turns, noise += wiener * wiener * mean;
    }
  }
  InStep out;
  if (!(squares > 0.0)) return out;
  const double per_bin = 0.5 / (kOfHannWindow * spectra.independent);
  const Eigen::Vector3d by_turn = inverse_of(normal) * per_turn;
  const double variance = per_bin * by_turn.dot(scatter * by_turn);
  if (variance > 0.0) out.turn = by_turn.dot(right), out.turn_sigma = std::sqrt(variance);
  const auto freedom = static_cast<double>(residual.rows() - model.q_high().cols());
  const double beyond = std::max(pattern.squaredNorm() - freedom * per_bin * noise, 0.0);
  out.pattern = std::sqrt(beyond) / squares / field_of(fit, motion).norm();
  return out;
}

}  // namespace core::closure
