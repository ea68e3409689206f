#include "core/structure/first_order.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/structure/mode_residuals.h"

namespace core::structure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLeastSeen = 1e-6;    // of a direction: part of it that the model's own parameters do not explain
constexpr double kLeastFree = 1e-9;    // pivot of I - H_ii: the others determine what predicts mode i
constexpr double kSmallChange = 1e-3;  // of an initial value's distance from the value without the effect

Index rows_of(const ReferenceMode& mode) { return 1 + static_cast<Index>(mode.shape.size()); }

// Orthonormal basis of the columns that are not zero.
MatrixXd basis_of(const MatrixXd& jacobian) {
  std::vector<Index> kept;
  for (Index k = 0; k < jacobian.cols(); ++k) {
    if (jacobian.col(k).norm() > 0.0) kept.push_back(k);
  }
  MatrixXd scaled = jacobian(Eigen::all, kept);
  scaled.colwise().normalize();
  if (scaled.cols() == 0) return scaled;
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(scaled);
  return qr.householderQ() * MatrixXd::Identity(scaled.rows(), qr.rank());
}

// The same with a row for each finite width, 1 / width, of which the basis keeps the rows of the data.
MatrixXd limited_basis_of(const MatrixXd& jacobian, const VectorXd& widths) {
  MatrixXd limited = MatrixXd::Zero(jacobian.rows() + jacobian.cols(), jacobian.cols());
  limited.topRows(jacobian.rows()) = jacobian;
  for (Index k = 0; k < jacobian.cols(); ++k) {
    if (jacobian.col(k).norm() > 0.0) limited(jacobian.rows() + k, k) = 1.0 / widths(k);  // 0 of an infinite one
  }
  return basis_of(limited).topRows(jacobian.rows());
}

// Change of the residuals from the fit on, by a small effect at one place; empty: no modes there.
std::optional<VectorXd> change_of(const FrameModel& with, const std::vector<ReferenceMode>& reference,
                                  const FrameFit& fit, double place, const EffectParameter& size, double start) {
  VectorXd p(with.n_parameters());
  p.head(fit.parameters.size()) = fit.parameters;
  Index at = fit.parameters.size();
  if (p.size() - at > 1) p(at++) = place;
  VectorXd neutral, moved;
  p(at) = size.neutral;
  if (!residuals_of(with, reference, -1, p, neutral)) return std::nullopt;
  p(at) = size.neutral + kSmallChange * (start - size.neutral);
  if (!residuals_of(with, reference, -1, p, moved)) return std::nullopt;
  return moved - neutral;
}

}  // namespace

std::optional<HeldOutModes> HeldOutModes::about(const FrameModel& model, const std::vector<ReferenceMode>& reference,
                                                const FrameFit& fit) {
  if (!fit.ok || !determines(model, reference, fit)) return std::nullopt;
  HeldOutModes out;
  MatrixXd free = fit.jacobian;
  for (Index k = 0; k < free.cols(); ++k) {
    if (fit.is_at_bound[static_cast<std::size_t>(k)]) free.col(k).setZero();
  }
  out.basis_ = limited_basis_of(free, model.limits_at(fit.parameters));
  Index row = 0;
  for (const ReferenceMode& mode : reference) {
    const Index n = rows_of(mode);
    const MatrixXd own = out.basis_.middleRows(row, n);
    const MatrixXd rest = MatrixXd::Identity(n, n) - own * own.transpose();
    const Eigen::LDLT<MatrixXd> ldlt(rest);
    if (!(ldlt.vectorD().minCoeff() > kLeastFree)) return std::nullopt;
    out.inverse_.push_back(ldlt.solve(MatrixXd::Identity(n, n)));
    row += n;
  }
  return out;
}

VectorXd HeldOutModes::fitted_residuals(const VectorXd& data) const {
  return data - basis_ * (basis_.transpose() * data);
}

double HeldOutModes::chi2(const VectorXd& fitted_residuals) const {
  double sum = 0.0;
  Index row = 0;
  for (const MatrixXd& inverse : inverse_) {
    sum += (inverse * fitted_residuals.segment(row, inverse.rows())).squaredNorm();
    row += inverse.rows();
  }
  return sum;
}

double HeldOutModes::chi2_with(const VectorXd& direction, const VectorXd& fitted_residuals) const {
  const double size = direction.dot(fitted_residuals);
  const double share = size * size / (size * size + 1.0);  // that a fit limited by this size explains
  if (!(share > 0.0)) return chi2(fitted_residuals);
  const VectorXd rest = fitted_residuals - direction * share * size;
  double sum = 0.0;
  Index row = 0;
  for (const MatrixXd& inverse : inverse_) {  // Sherman and Morrison: one further column
    const VectorXd lifted = inverse * direction.segment(row, inverse.rows());
    const double left = 1.0 / share - lifted.dot(direction.segment(row, inverse.rows()));
    if (!(left > kLeastFree)) return std::numeric_limits<double>::infinity();
    const VectorXd plain = inverse * rest.segment(row, inverse.rows());
    sum += (plain + lifted * (lifted.dot(rest.segment(row, inverse.rows())) / left)).squaredNorm();
    row += inverse.rows();
  }
  return sum;
}

std::optional<FirstOrderEffects> FirstOrderEffects::about(const FrameModel& model,
                                                          const std::vector<const StructuralEffect*>& effects,
                                                          const std::vector<ReferenceMode>& reference,
                                                          const FrameFit& fit) {
  FirstOrderEffects out;
  out.held_out_ = HeldOutModes::about(model, reference, fit);
  if (!out.held_out_) return std::nullopt;
  out.n_effects_ = effects.size();
  std::vector<VectorXd> units;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const std::vector<EffectParameter> own = effects[e]->parameters(*model.declared);
    const bool placed = own.size() == 2 && own.front().is_place;
    if (!(placed || own.size() == 1) || own.back().is_place || !std::isfinite(own.back().neutral)) return std::nullopt;
    const EffectParameter& size = own.back();
    const bool one_sided = size.neutral <= size.low || size.neutral >= size.high;
    FrameModel with = model;
    with.effects.push_back(effects[e]);
    for (const double place : placed ? own.front().starts : std::vector<double>{1.0}) {
      const auto change = change_of(with, reference, fit, place, size, size.starts.front());
      if (!change) continue;
      const VectorXd rest = out.held_out_->fitted_residuals(*change);
      if (!(rest.norm() > kLeastSeen * change->norm())) continue;
      units.push_back(rest.normalized());
      out.directions_.push_back({e, one_sided});
    }
  }
  out.unit_.resize(fit.n_data, static_cast<Index>(units.size()));
  for (std::size_t i = 0; i < units.size(); ++i) out.unit_.col(static_cast<Index>(i)) = units[i];
  return out;
}

// Residuals are model minus data: an effect that the data show lowers them along its direction.
double FirstOrderEffects::gain(std::size_t i, double along) const {
  return directions_[i].is_one_sided && along > 0.0 ? 0.0 : along * along;
}

double FirstOrderEffects::largest_gain(const VectorXd& data) const {
  const VectorXd along = unit_.transpose() * data;
  double best = 0.0;
  for (std::size_t i = 0; i < directions_.size(); ++i) best = std::max(best, gain(i, along(static_cast<Index>(i))));
  return best;
}

double FirstOrderEffects::largest_score(const VectorXd& data) const {
  const VectorXd residuals = held_out_->fitted_residuals(data);
  const VectorXd along = unit_.transpose() * residuals;
  const double before = held_out_->chi2(residuals);
  std::vector<std::pair<double, Index>> best(n_effects_, {0.0, -1});
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const auto at = static_cast<Index>(i);
    best[directions_[i].effect] = std::max(best[directions_[i].effect], {gain(i, along(at)), at});
  }
  double score = 0.0;
  for (const auto& [squares, at] : best) {
    if (at >= 0 && squares > 0.0) score = std::max(score, before - held_out_->chi2_with(unit_.col(at), residuals));
  }
  return score;
}

}  // namespace core::structure
