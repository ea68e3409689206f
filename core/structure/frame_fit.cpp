#include "core/structure/frame_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/linear/damped_least_squares.h"
#include "core/structure/mode_residuals.h"

namespace core::structure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kIterations = 60;

struct Bounds {
  VectorXd low, high, step;  // step: of numerical derivatives
  std::vector<bool> is_place;
};

Bounds bounds_of(const FrameModel& model) {
  const Index n = model.n_parameters();
  Bounds out{VectorXd::Constant(n, -60.0), VectorXd::Constant(n, 60.0), VectorXd::Constant(n, 1e-6), {}};
  out.is_place.assign(static_cast<std::size_t>(n), false);
  Index at = model.has_scale() ? 1 : 0;
  for (const std::size_t i : model.with_prior()) {
    const ModelParameter& p = model.declared->model->parameters()[i];
    out.low(at) = (p.low - p.value) / p.prior_sigma;
    out.high(at) = (p.high - p.value) / p.prior_sigma;
    out.step(at++) = 1e-4;
  }
  for (const StructuralEffect* effect : model.effects) {
    for (const EffectParameter& p : effect->parameters(*model.declared)) {
      out.low(at) = p.low;
      out.high(at) = p.high;
      out.is_place[static_cast<std::size_t>(at)] = p.is_place;
      out.step(at++) = 1e-6 * std::max(std::abs(p.starts.back()), 1e-3);
    }
  }
  return out;
}

class Problem {
 public:
  Problem(const FrameModel& model, const std::vector<ReferenceMode>& reference, int without)
      : model_(model), reference_(reference), without_(without), bounds_(bounds_of(model)) {}

  [[nodiscard]] bool residuals(const VectorXd& p, VectorXd& out) const {
    return residuals_of(model_, reference_, without_, p, out);
  }

  [[nodiscard]] bool jacobian(const VectorXd& p, const VectorXd& r, MatrixXd& out) const {
    out.resize(r.size(), p.size());
    if (has_analytic_jacobian(model_)) return analytic_jacobian(model_, reference_, without_, p, out);
    VectorXd moved;
    for (Index k = 0; k < p.size(); ++k) {
      if (bounds_.is_place[static_cast<std::size_t>(k)]) {
        out.col(k).setZero();
        continue;
      }
      const double step = bounds_.step(k) + 1e-6 * std::abs(p(k));
      VectorXd q = p;
      q(k) += q(k) + step > bounds_.high(k) ? -step : step;
      if (!residuals(q, moved)) {
        q(k) = p(k) - step;
        if (!residuals(q, moved)) return false;
      }
      out.col(k) = (moved - r) / (q(k) - p(k));
    }
    return true;
  }

  // Minimises from p on; false if p does not give a frame.
  [[nodiscard]] bool minimise(FrameFit& fit, VectorXd p) const {
    p = p.cwiseMax(bounds_.low).cwiseMin(bounds_.high);
    VectorXd r;
    if (!residuals(p, r)) return false;
    Damping damping{.value = 1e-4, .most = 1e12};
    MatrixXd j;
    for (int i = 0; i < kIterations && p.size() > 0; ++i) {
      if (!jacobian(p, r, j)) return false;
      if (!improve(j, p, r, damping)) break;
    }
    if (!jacobian(p, r, fit.jacobian)) return false;
    fit.ok = true;
    fit.chi2 = r.squaredNorm();
    fit.n_data = r.size();
    for (std::size_t i = 0; i < reference_.size(); ++i)
      fit.n_scales += static_cast<int>(i) != without_ && !reference_[i].shape.empty() ? 1 : 0;
    fit.is_place = bounds_.is_place;
    for (Index k = 0; k < p.size(); ++k) fit.is_at_bound.push_back(!(p(k) > bounds_.low(k) && p(k) < bounds_.high(k)));
    fit.residuals = std::move(r);
    fit.parameters = std::move(p);
    return true;
  }

 private:
  // One step that reduces the squares; false if there is no significant one.
  bool improve(const MatrixXd& j, VectorXd& p, VectorXd& r, Damping& damping) const {
    const VectorXd gradient = j.transpose() * r;
    MatrixXd normal = j.transpose() * j;
    for (Index k = 0; k < p.size(); ++k) {  // a parameter at its bound that would leave it stays
      const bool held = (p(k) <= bounds_.low(k) && gradient(k) > 0.0) || (p(k) >= bounds_.high(k) && gradient(k) < 0.0);
      if (!held && normal(k, k) > 0.0) continue;
      normal.row(k).setZero();
      normal.col(k).setZero();
      normal(k, k) = 1.0;
    }
    double gain = 0.0;
    const double before = r.squaredNorm();
    const bool went = damped_step(normal, gradient, damping, [&](VectorXd step) {
      for (Index k = 0; k < p.size(); ++k) {
        if ((p(k) <= bounds_.low(k) && gradient(k) > 0.0) || (p(k) >= bounds_.high(k) && gradient(k) < 0.0))
          step(k) = 0.0;
      }
      const VectorXd q = (p + step).cwiseMax(bounds_.low).cwiseMin(bounds_.high);
      VectorXd moved;
      if (!residuals(q, moved) || !(moved.squaredNorm() < before)) return false;
      gain = before - moved.squaredNorm();
      p = q;
      r = std::move(moved);
      return true;
    });
    return went && gain > 1e-10 * (before + 1e-6);
  }

  const FrameModel& model_;
  const std::vector<ReferenceMode>& reference_;
  int without_;
  Bounds bounds_;
};

// Initial ln(stiffness over mass), from all reference modes and the plain model.
double first_scale(const FrameModel& model, const std::vector<ReferenceMode>& reference) {
  const auto own = model.declared->model ? seen_modes({model.declared, {}}, VectorXd::Zero(model.n_scale()), false)
                                         : frame_modes(uniform_frame(*model.declared, 1.0), false);
  if (!own) return 0.0;
  double sum = 0.0;
  for (const ReferenceMode& mode : reference) {
    if (mode.number <= own->frequency_hz.size())
      sum += std::log(mode.frequency_hz / own->frequency_hz(mode.number - 1));
  }
  return 2.0 * sum / static_cast<double>(reference.size());
}

// All combinations of initial values of the last effect, appended to the known values of the others.
std::vector<VectorXd> starts_of(const FrameModel& model, const std::vector<ReferenceMode>& reference,
                                const VectorXd& before) {
  const Index n = model.n_parameters();
  VectorXd base = VectorXd::Zero(n);
  if (model.has_scale()) base(0) = first_scale(model, reference);
  base.head(std::min(before.size(), n)) = before.head(std::min(before.size(), n));
  std::vector<VectorXd> out{base};
  if (before.size() >= n || model.effects.empty()) return out;
  const std::vector<EffectParameter> last = model.effects.back()->parameters(*model.declared);
  for (std::size_t k = 0; k < last.size(); ++k) {
    std::vector<VectorXd> more;
    for (const VectorXd& p : out) {
      for (const double start : last[k].starts) {
        more.push_back(p);
        more.back()(n - static_cast<Index>(last.size() - k)) = start;
      }
    }
    out = std::move(more);
  }
  return out;
}

}  // namespace

FrameFit fit_frame(const FrameModel& model, const std::vector<ReferenceMode>& reference, const VectorXd& before,
                   Starts starts, int without) {
  const Problem problem(model, reference, without);
  std::vector<VectorXd> all = starts_of(model, reference, before);
  if (starts == Starts::kBest && all.size() > 1) {
    const auto squares = [&](const VectorXd& p) {
      VectorXd r;
      return problem.residuals(p, r) ? r.squaredNorm() : kInfinity;
    };
    all = {*std::min_element(all.begin(), all.end(),
                             [&](const VectorXd& a, const VectorXd& b) { return squares(a) < squares(b); })};
  }
  FrameFit best;
  for (const VectorXd& start : all) {
    FrameFit fit;
    if (problem.minimise(fit, start) && (!best.ok || fit.chi2 < best.chi2)) best = std::move(fit);
  }
  return best;
}

// Places are chosen from few, and priors are data of their own: neither takes a mode.
bool determines(const FrameModel& model, const std::vector<ReferenceMode>& reference, const FrameFit& fit) {
  const auto n = static_cast<Index>(reference.size());
  const Index free = fit.parameters.size() - static_cast<Index>(model.with_prior().size()) -
                     std::count(fit.is_place.begin(), fit.is_place.end(), true);
  return n >= 2 && n - 1 >= free;
}

LeaveOneOut leave_one_out(const FrameModel& model, const std::vector<ReferenceMode>& reference, const FrameFit& fit) {
  LeaveOneOut out;
  out.chi2 = out.rms_percent = out.with_shapes_percent = kInfinity;
  const auto n = static_cast<Index>(reference.size());
  if (!fit.ok || !determines(model, reference, fit)) return out;
  double chi2 = 0.0, squares = 0.0, with_shapes = 0.0;
  std::vector<double> errors;
  FrameModel limited = model;
  limited.limits = model.limits_at(fit.parameters);
  for (Index i = 0; i < n; ++i) {
    const FrameFit others = fit_frame(limited, reference, fit.parameters, Starts::kBest, static_cast<int>(i));
    if (!others.ok) return out;
    const ReferenceMode& mode = reference[static_cast<std::size_t>(i)];
    const auto modes = seen_modes(model, others.parameters, !mode.shape.empty());
    if (!modes) return out;
    std::vector<double> residuals;
    append_residuals(*modes, mode, residuals);
    const auto square = [](double sum, double r) { return sum + r * r; };
    const double of_shape = std::accumulate(residuals.begin() + 1, residuals.end(), 0.0, square);
    chi2 += residuals.front() * residuals.front() + of_shape;
    errors.push_back(modes->frequency_hz(mode.number - 1) / mode.frequency_hz - 1.0);
    squares += errors.back() * errors.back();
    const double sigma = mode.sigma_hz / mode.frequency_hz;
    with_shapes += errors.back() * errors.back();
    if (!mode.shape.empty()) with_shapes += sigma * sigma * of_shape / static_cast<double>(mode.shape.size());
  }
  if (!std::isfinite(chi2)) return out;
  out.chi2 = chi2;
  out.rms_percent = 100.0 * std::sqrt(squares / static_cast<double>(n));
  out.with_shapes_percent = 100.0 * std::sqrt(with_shapes / static_cast<double>(n));
  out.relative_error = std::move(errors);
  return out;
}

MatrixXd parameter_covariance(const FrameFit& fit) {
  const Index all = fit.parameters.size();
  MatrixXd out = MatrixXd::Constant(all, all, std::numeric_limits<double>::quiet_NaN());
  if (!fit.ok || all == 0) return out;
  std::vector<Index> kept;  // places have no derivative
  for (Index k = 0; k < all; ++k) {
    if (fit.is_place.empty() || !fit.is_place[static_cast<std::size_t>(k)]) kept.push_back(k);
  }
  const MatrixXd jacobian = fit.jacobian(Eigen::all, kept);
  const auto n = static_cast<Index>(kept.size());
  VectorXd size(n);  // columns scaled to unit norm: parameters differ by orders of magnitude
  for (Index k = 0; k < n; ++k) size(k) = jacobian.col(k).norm();
  if (n == 0 || !(size.minCoeff() > 0.0)) return out;
  const MatrixXd scaled = jacobian * size.cwiseInverse().asDiagonal();
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(scaled);
  if (qr.rank() < n || std::abs(double{qr.matrixQR()(n - 1, n - 1)}) < 1e-7) return out;
  const MatrixXd inverse = (scaled.transpose() * scaled).llt().solve(MatrixXd::Identity(n, n));
  for (Index i = 0; i < n; ++i) {
    for (Index k = 0; k < n; ++k)
      out(kept[static_cast<std::size_t>(i)], kept[static_cast<std::size_t>(k)]) = inverse(i, k) / (size(i) * size(k));
  }
  return out;
}

VectorXd parameter_sigmas(const FrameFit& fit) { return parameter_covariance(fit).diagonal().cwiseSqrt(); }

double chi2_limit(double degrees_of_freedom) {
  constexpr double kNormal = 2.748;  // normal quantile exceeded with probability 0.003
  const double part = 2.0 / (9.0 * degrees_of_freedom);
  return degrees_of_freedom * std::pow(1.0 - part + kNormal * std::sqrt(part), 3);
}

}  // namespace core::structure
