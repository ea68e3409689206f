#include "core/structure/mode_residuals.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/structure/mode_numbers.h"

namespace core::structure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Scaled {
  VectorXd weight, shape;  // 1 / sigma^2, measured
  explicit Scaled(const ReferenceMode& mode)
      : weight(static_cast<Index>(mode.shape.size())), shape(static_cast<Index>(mode.shape.size())) {
    for (Index i = 0; i < shape.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      weight(i) = 1.0 / (mode.shape_sigma[at] * mode.shape_sigma[at]);
      shape(i) = mode.shape[at];
    }
  }
};

// d values / d parameters by differences: laws of effects are smooth, and cost nothing.
MatrixXd value_slopes(const FrameModel& model, const VectorXd& p) {
  const VectorXd values = values_of(model, p);
  MatrixXd out = MatrixXd::Zero(values.size(), p.size());
  for (Index k = model.has_scale() ? 1 : 0; k < p.size(); ++k) {
    const double step = 1e-7 * std::max(1.0, std::abs(p(k)));
    VectorXd up = p, down = p;
    up(k) += step, down(k) -= step;
    out.col(k) = (values_of(model, up) - values_of(model, down)) / (2.0 * step);
    // At a bound of a parameter of the model only one side moves.
    if ((values_of(model, up) - values).cwiseAbs().maxCoeff() == 0.0 ||
        (values_of(model, down) - values).cwiseAbs().maxCoeff() == 0.0)
      out.col(k) *= 2.0;
  }
  return out;
}

}  // namespace

void append_residuals(const FrameModes& modes, const ReferenceMode& mode, std::vector<double>& out) {
  const Index r = mode.number - 1;
  out.push_back((modes.frequency_hz(r) / mode.frequency_hz - 1.0) * mode.frequency_hz / mode.sigma_hz);
  if (mode.shape.empty()) return;
  double along = 0.0, square = 0.0;
  for (std::size_t i = 0; i < mode.shape.size(); ++i) {
    const double weight = 1.0 / (mode.shape_sigma[i] * mode.shape_sigma[i]);
    const double component = modes.shapes(static_cast<Index>(i), r);
    along += weight * component * mode.shape[i];
    square += weight * component * component;
  }
  for (std::size_t i = 0; i < mode.shape.size(); ++i)
    out.push_back((modes.shapes(static_cast<Index>(i), r) * along / square - mode.shape[i]) / mode.shape_sigma[i]);
}

bool residuals_of(const FrameModel& model, const std::vector<ReferenceMode>& reference, int without, const VectorXd& p,
                  VectorXd& out) {
  const bool with_shapes =
      std::any_of(reference.begin(), reference.end(), [](const ReferenceMode& m) { return !m.shape.empty(); });
  const auto modes = seen_modes(model, p, with_shapes);
  if (!modes) return false;
  std::vector<double> values;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    if (static_cast<int>(i) != without) append_residuals(*modes, reference[i], values);
  }
  for (Index k = model.has_scale() ? 1 : 0; k < model.n_scale(); ++k) values.push_back(p(k));
  if (model.limits.size() > 0) {
    const VectorXd neutral = model.neutral();
    for (Index k = 0; k < p.size(); ++k) {
      if (std::isfinite(model.limits(k))) values.push_back((p(k) - neutral(k)) / model.limits(k));
    }
  }
  out = Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
  return out.allFinite();
}

bool has_analytic_jacobian(const FrameModel& model) {
  if (!model.declared->model) return false;
  return std::none_of(model.effects.begin(), model.effects.end(),
                      [](const StructuralEffect* effect) { return effect->changes_frequencies(); });
}

bool analytic_jacobian(const FrameModel& model, const std::vector<ReferenceMode>& reference, int without,
                       const VectorXd& p, MatrixXd& out) {
  if (p.size() == 0) return true;
  const MatrixXd slopes = value_slopes(model, p);
  std::vector<std::size_t> moved;
  for (Index v = 0; v < slopes.rows(); ++v) {
    if (slopes.row(v).cwiseAbs().maxCoeff() > 0.0) moved.push_back(static_cast<std::size_t>(v));
  }
  const DeclaredFrame& declared = *model.declared;
  auto modes = declared.model->modes(values_of(model, p), declared.n_storeys, moved);
  if (!modes || modes->frequency_hz.size() < static_cast<Index>(declared.n_storeys)) return false;
  if (declared.numbering) number_as(*declared.numbering, *modes);
  const double factor = model.has_scale() ? std::exp(0.5 * p(0)) : 1.0;
  const auto n_moved = static_cast<Index>(moved.size());
  MatrixXd by_value(out.rows(), n_moved);
  VectorXd by_scale = VectorXd::Zero(out.rows());
  Index row = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    if (static_cast<int>(i) == without) continue;
    const ReferenceMode& mode = reference[i];
    const Index r = mode.number - 1;
    by_scale(row) = 0.5 * factor * modes->frequency_hz(r) / mode.sigma_hz;
    for (Index v = 0; v < n_moved; ++v) by_value(row, v) = factor * modes->d_frequency_hz(r, v) / mode.sigma_hz;
    ++row;
    if (mode.shape.empty()) continue;
    const Scaled seen(mode);
    const VectorXd phi = modes->shapes.col(r);
    const double along = (seen.weight.array() * phi.array() * seen.shape.array()).sum();
    const double square = (seen.weight.array() * phi.array().square()).sum();
    for (Index v = 0; v < n_moved; ++v) {
      const VectorXd d = modes->d_shapes[static_cast<std::size_t>(v)].col(r);
      const double d_along = (seen.weight.array() * d.array() * seen.shape.array()).sum();
      const double d_square = 2.0 * (seen.weight.array() * phi.array() * d.array()).sum();
      by_value.col(v).segment(row, phi.size()) =
          (d * along / square + phi * (d_along - along * d_square / square) / square)
              .cwiseProduct(seen.weight.cwiseSqrt());
    }
    row += phi.size();
  }
  out.setZero();
  for (Index v = 0; v < n_moved; ++v)
    out.topRows(row) += by_value.col(v).head(row) * slopes.row(static_cast<Index>(moved[static_cast<std::size_t>(v)]));
  if (model.has_scale()) out.col(0) = by_scale;
  for (Index k = model.has_scale() ? 1 : 0; k < model.n_scale(); ++k) out(row++, k) = 1.0;
  for (Index k = 0; k < model.limits.size(); ++k) {
    if (std::isfinite(model.limits(k))) out(row++, k) = 1.0 / model.limits(k);
  }
  return out.allFinite();
}

}  // namespace core::structure
