#include "core/closure/response/free_decay_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/types/constants.h"

namespace core::closure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Complex = FreeDecayFit::Complex;

constexpr int kSubsteps = 6;  // per sample, midpoint rule
constexpr double kLeastX = -4.0, kMostX = 3.0, kDecayStep = 1e-5, kSettled = 1e-7;
constexpr double kReferenceShare = 0.15;  // of the largest displacement

}  // namespace

FreeDecayFit::FreeDecayFit(const FreeDecays& decays, std::vector<const DecayEffect*> effects)
    : decays_(decays), effects_(std::move(effects)), n_channels_(decays.release.front().cols()) {
  VectorXd squares = VectorXd::Zero(n_channels_);
  double largest = 0.0;
  for (const MatrixXd& decay : decays_.release) squares += decay.colwise().squaredNorm().transpose();
  squares.maxCoeff(&reference_);
  for (const MatrixXd& decay : decays_.release)
    largest = std::max(largest, decay.col(reference_).cwiseAbs().maxCoeff());
  reference_amplitude_ = std::max(kReferenceShare * largest, 1e-12);
  for (const DecayEffect* effect : effects_) {
    adds_mode_ = adds_mode_ || effect->adds_mode();
    rest_drifts_ = rest_drifts_ || effect->rest_drifts();
  }
}

Index FreeDecayFit::further_at() const {
  Index n = 2 * n_channels_;  // rate, frequency, shape without the reference component
  for (const DecayEffect* effect : effects_) n += static_cast<Index>(effect->n_parameters());
  return n;
}

Index FreeDecayFit::n_common() const { return further_at() + (adds_mode_ ? 2 * n_channels_ : 0); }

const double* FreeDecayFit::of_effect(const State& state, std::size_t effect) const {
  Index at = 2 * n_channels_;
  for (std::size_t e = 0; e < effect; ++e) at += static_cast<Index>(effects_[e]->n_parameters());
  return state.common.data() + at;
}

DecayRates FreeDecayFit::rates(const State& state, double x) const {
  DecayRates out{state.common(0), state.common(1)};
  const double bounded = std::clamp(x, kLeastX, kMostX);
  const double* at = state.common.data() + 2 * n_channels_;
  for (const DecayEffect* effect : effects_) {
    effect->apply(at, bounded, out);
    at += effect->n_parameters();
  }
  out.log_rate = std::clamp(out.log_rate, -20.0, 10.0);
  return out;
}

DecayRates FreeDecayFit::further_rates(const State& state) const {
  return {state.common(further_at()), state.common(further_at() + 1)};
}

Eigen::VectorXcd FreeDecayFit::shape(const State& state, bool further) const {
  Eigen::VectorXcd out(n_channels_);
  Index at = further ? further_at() + 2 : 2;
  for (Index c = 0; c < n_channels_; ++c) {
    if (c == reference_) {
      out(c) = 1.0;
      continue;
    }
    out(c) = Complex(state.common(at), state.common(at + 1));
    at += 2;
  }
  return out;
}

std::vector<double> FreeDecayFit::range_of_x() const { return {-2.0, -std::log(kReferenceShare)}; }

MatrixXd FreeDecayFit::predicted(const State& state, std::size_t release) const {
  const Index n = decays_.release[release].rows();
  const VectorXd& own = state.own[release];
  const Eigen::VectorXcd first = shape(state, false);
  const double dt = 1.0 / decays_.rate_hz / kSubsteps, log_reference = std::log(reference_amplitude_);
  double log_amplitude = std::clamp(own(0), -30.0, 30.0), phase = own(1);
  MatrixXd out(n, n_channels_);
  for (Index k = 0; k < n; ++k) {
    out.row(k) = (first * std::polar(std::exp(log_amplitude), phase)).real().transpose();
    for (int i = 0; i < kSubsteps; ++i) {
      const DecayRates here = rates(state, log_amplitude - log_reference);
      const DecayRates middle = rates(state, log_amplitude - 0.5 * dt * std::exp(here.log_rate) - log_reference);
      log_amplitude = std::max(log_amplitude - dt * std::exp(middle.log_rate), -60.0);
      phase += kTwoPi * dt * middle.frequency_hz;
    }
  }
  if (!adds_mode_) return out;
  const DecayRates linear = further_rates(state);
  const Eigen::VectorXcd second = shape(state, true) * Complex(own(2), own(3));
  const Complex pole(-std::exp(std::clamp(linear.log_rate, -20.0, 10.0)), kTwoPi * linear.frequency_hz);
  for (Index k = 0; k < n; ++k)
    out.row(k) += (second * std::exp(pole * (static_cast<double>(k) / decays_.rate_hz))).real().transpose();
  return out;
}

MatrixXd FreeDecayFit::residual(const State& state, std::size_t release) const {
  MatrixXd out = decays_.release[release] - predicted(state, release);
  out.rowwise() -= out.colwise().mean().eval();
  if (rest_drifts_) {
    VectorXd t = VectorXd::LinSpaced(out.rows(), -1.0, 1.0);
    t.normalize();
    out -= (t * (t.transpose() * out)).eval();
  }
  return out;
}

double FreeDecayFit::squares(const State& state, int without) const {
  double sum = 0.0;
  for (std::size_t r = 0; r < decays_.release.size(); ++r) {
    if (static_cast<int>(r) != without) sum += residual(state, r).squaredNorm();
  }
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::max();
}

// One Levenberg-Marquardt step over common and own parameters; false if no step reduces the squares.
bool FreeDecayFit::step(State& state, int without, Damping& damping, double& best) const {
  const Index common = n_common(), own = n_own(), all = common + own * static_cast<Index>(state.own.size());
  MatrixXd normal = MatrixXd::Zero(all, all);
  VectorXd gradient = VectorXd::Zero(all);
  State moved = state;
  for (std::size_t r = 0; r < state.own.size(); ++r) {
    if (static_cast<int>(r) == without) continue;
    const MatrixXd here = residual(state, r);
    MatrixXd jacobian(here.size(), common + own);
    for (Index p = 0; p < common + own; ++p) {
      double& value = p < common ? moved.common(p) : moved.own[r](p - common);
      const double kept = value, h = kDecayStep * std::max(std::abs(kept), 0.1);
      value = kept + h;
      jacobian.col(p) = (residual(moved, r) - here).reshaped() / h;
      value = kept;
    }
    std::vector<Index> at(static_cast<std::size_t>(common + own));
    for (Index p = 0; p < common + own; ++p)
      at[static_cast<std::size_t>(p)] = p < common ? p : p + own * static_cast<Index>(r);
    const MatrixXd squares_of = jacobian.transpose() * jacobian;
    const VectorXd along = jacobian.transpose() * here.reshaped();
    normal(at, at) += squares_of;
    for (std::size_t i = 0; i < at.size(); ++i) gradient(at[i]) += along(static_cast<Index>(i));
  }
  normal.diagonal().array() += 1e-12 * (1.0 + normal.trace());
  bool goes_on = false;
  const bool went = damped_step(normal, gradient, damping, [&](const VectorXd& change) {
    moved = state;
    moved.common += change.head(common);
    for (std::size_t r = 0; r < state.own.size(); ++r)
      moved.own[r] += change.segment(common + own * static_cast<Index>(r), own);
    const double reached = squares(moved, without);
    if (!(reached < best)) return false;
    goes_on = best - reached > kSettled * best;
    state = moved;
    best = reached;
    return true;
  });
  return went && goes_on;
}

void FreeDecayFit::refine(State& state, int without, int n_iterations) const {
  Damping damping;
  double best = squares(state, without);
  for (int i = 0; i < n_iterations && step(state, without, damping, best); ++i) {
  }
  if (without >= 0) fit_own(state, static_cast<std::size_t>(without), n_iterations);
}

// Fits amplitude and phase of one release, with all other parameters fixed.
void FreeDecayFit::fit_own(State& state, std::size_t release, int n_iterations) const {
  double best = residual(state, release).squaredNorm();
  Damping damping;
  for (int i = 0; i < n_iterations; ++i) {
    const MatrixXd here = residual(state, release);
    MatrixXd jacobian(here.size(), n_own());
    State moved = state;
    for (Index p = 0; p < n_own(); ++p) {
      double& value = moved.own[release](p);
      const double kept = value, h = kDecayStep * std::max(std::abs(kept), 0.1);
      value = kept + h;
      jacobian.col(p) = (residual(moved, release) - here).reshaped() / h;
      value = kept;
    }
    MatrixXd normal = jacobian.transpose() * jacobian;
    normal.diagonal().array() += 1e-300;
    const VectorXd gradient = jacobian.transpose() * here.reshaped();
    const bool went = damped_step(normal, gradient, damping, [&](const VectorXd& change) {
      moved.own[release] = state.own[release] + change;
      const double reached = residual(moved, release).squaredNorm();
      if (!(reached < best * (1.0 - kSettled))) return false;
      best = reached;
      state = moved;
      return true;
    });
    if (!went) return;
  }
}

}  // namespace core::closure
