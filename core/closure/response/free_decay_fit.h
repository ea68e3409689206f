#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "core/closure/response/effects/decay_effect.h"
#include "core/closure/response/free_decay_releases.h"
#include "core/linear/damped_least_squares.h"

namespace core::closure {

// Free decays as one mode whose rates may depend on its amplitude a (of the reference channel, the largest):
//   d ln a / dt = - rate(ln a),  d phase / dt = 2 pi frequency(ln a),  channel c = Re(shape_c a e^(i phase)) + rest_c,
// optionally with one more, linear mode. Common to all releases: rates, shapes, effects. Per release: amplitude, phase,
// equilibrium (and its slope). Levenberg-Marquardt with difference derivatives.
class FreeDecayFit {
 public:
  // Borrows both arguments.
  FreeDecayFit(const FreeDecays& decays, std::vector<const DecayEffect*> effects);

  struct State {
    Eigen::VectorXd common;
    std::vector<Eigen::VectorXd> own;  // per release
  };
  using Complex = std::complex<double>;

  // Initial state with the mode alone: the best of a grid of frequencies and decay rates.
  [[nodiscard]] State linear_start() const;
  // Initial states from a fit with all effects but the last.
  [[nodiscard]] std::vector<State> starts_from(const State& before) const;
  // Refines the state on all releases except `without` (-1 = none), whose own parameters are fitted afterwards.
  void refine(State& state, int without, int n_iterations) const;
  [[nodiscard]] Eigen::MatrixXd residual(const State& state, std::size_t release) const;
  [[nodiscard]] Eigen::MatrixXd predicted(const State& state, std::size_t release) const;  // equilibrium excluded
  [[nodiscard]] double squares(const State& state, int without = -1) const;

  [[nodiscard]] DecayRates rates(const State& state, double x) const;
  [[nodiscard]] double reference_amplitude() const noexcept { return reference_amplitude_; }
  [[nodiscard]] const double* of_effect(const State& state, std::size_t effect) const;
  [[nodiscard]] Eigen::VectorXcd shape(const State& state, bool further) const;
  [[nodiscard]] DecayRates further_rates(const State& state) const;
  [[nodiscard]] std::vector<double> range_of_x() const;  // smallest and largest amplitude that are informative

 private:
  [[nodiscard]] Eigen::Index n_common() const;
  [[nodiscard]] Eigen::Index further_at() const;
  [[nodiscard]] Eigen::Index n_own() const { return adds_mode_ ? 4 : 2; }
  void set_own_by_grid(State& state, std::size_t release) const;
  void fit_own(State& state, std::size_t release, int n_iterations) const;
  [[nodiscard]] bool step(State& state, int without, Damping& damping, double& best) const;

  const FreeDecays& decays_;
  std::vector<const DecayEffect*> effects_;
  Eigen::Index n_channels_ = 0, reference_ = 0;
  double reference_amplitude_ = 1.0;
  bool adds_mode_ = false, rest_drifts_ = false;
};

}  // namespace core::closure
