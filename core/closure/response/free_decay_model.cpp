#include "core/closure/response/free_decay_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/closure/noise_stream.h"
#include "core/closure/response/effects/catalogue.h"
#include "core/closure/response/jackknife.h"
#include "core/closure/structure_words.h"

namespace core::closure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr int kIterations = 60, kIterationsLeftOut = 12, kIterationsMadeUp = 8, kIterationsMadeUpLeftOut = 3;
constexpr double kMoreThanNoise = 1.1;

std::vector<const DecayEffect*> by_names(const std::vector<std::string>& names) {
  std::vector<const DecayEffect*> out;
  for (const std::string& name : names) out.push_back(&decay_effect(name));
  return out;
}

double mac(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b) {
  return std::norm(a.dot(b)) / (a.squaredNorm() * b.squaredNorm());
}

std::vector<ParameterValue> values_of(const FreeDecayFit& fit, const FreeDecayFit::State& state, std::size_t effect,
                                      const DecayEffect& kind) {
  if (!kind.adds_mode()) return kind.describe(fit.of_effect(state, effect));
  const DecayRates rates = fit.further_rates(state);
  const double w = 2.0 * std::numbers::pi * rates.frequency_hz, rate = std::exp(rates.log_rate);
  return {{"frequency", "Hz", rates.frequency_hz, {}}, {"damping", "1", rate / std::hypot(w, rate), {}}};
}

std::string implausible(const FreeDecayFit& fit, const FreeDecayFit::State& state, const DecayEffect& kind,
                        double rate_hz) {
  for (const double x : fit.range_of_x()) {
    const double hz = fit.rates(state, x).frequency_hz;
    if (!(hz > 0.0 && hz < 0.5 * rate_hz)) return "the frequency leaves 0 .. half the rate within the decay";
  }
  if (!kind.adds_mode()) return {};
  const DecayRates rates = fit.further_rates(state);
  const double rate = std::exp(rates.log_rate), w = 2.0 * std::numbers::pi * rates.frequency_hz;
  if (rate > FreeDecayModel::kMostDamping * std::hypot(w, rate)) return "it is overdamped and does not oscillate";
  const double likeness = mac(fit.shape(state, false), fit.shape(state, true));
  return likeness <= FreeDecayModel::kTwinMac ? ""
                                              : "it has the first mode's shape (MAC " + number(likeness) +
                                                    "): an amplitude-dependent mode appears so in a linear model";
}

}  // namespace

std::vector<std::string> FreeDecayModel::effects() const {
  std::vector<std::string> out;
  for (const auto& effect : decay_effects()) {
    // A single channel has no shape: a second sine would fit any deviation.
    if (!(effect->adds_mode() && decays_.release.front().cols() < 2)) out.push_back(effect->name());
  }
  return out;
}

std::vector<NotObservable> FreeDecayModel::not_observable() const {
  std::vector<NotObservable> out{
      {"clock_rate", "a wrong rate scales every frequency and decay rate alike", "film a clock, and give --clock"},
      {"folded_mode",
       "a decay above half the rate (Nyquist frequency) cannot be distinguished from its alias "
       "below it",
       "film at another rate: an aliased mode moves, a true one stays"}};
  if (decays_.release.front().cols() < 2)
    out.push_back({"further_mode", "one channel has no shape", "film two floors or more"});
  return out;
}

const FreeDecayModel::State& FreeDecayModel::state_of(const std::vector<std::string>& effects) const {
  if (const auto found = states_.find(effects); found != states_.end()) return found->second;
  const FreeDecayFit fit(decays_, by_names(effects));
  State best;
  if (effects.empty()) {
    best = fit.linear_start();
    fit.refine(best, -1, kIterations);
  } else {
    double least = std::numeric_limits<double>::infinity();
    std::vector<State> starts = fit.starts_from(state_of({effects.begin(), effects.end() - 1}));
    if (made_up_) starts.resize(1);
    for (State& start : starts) {
      fit.refine(start, -1, made_up_ ? kIterationsMadeUp : kIterations);
      const double squares = fit.squares(start);
      if (squares < least) least = squares, best = std::move(start);
    }
  }
  return states_.emplace(effects, std::move(best)).first->second;
}

ResponseFit FreeDecayModel::fit(const std::vector<std::string>& effects) const {
  const FreeDecayFit fit(decays_, by_names(effects));
  const State& whole = state_of(effects);
  std::vector<State> without;
  for (std::size_t r = 0; r < decays_.release.size(); ++r) {
    without.push_back(whole);
    fit.refine(without.back(), static_cast<int>(r), made_up_ ? kIterationsMadeUpLeftOut : kIterationsLeftOut);
  }
  ResponseFit out = describe(fit, whole, without);
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const DecayEffect& kind = decay_effect(effects[e]);
    std::vector<ParameterValue> values = values_of(fit, whole, e, kind);
    std::vector<std::vector<ParameterValue>> others;
    for (const State& one : without) others.push_back(values_of(fit, one, e, kind));
    add_jackknife_sigmas(values, others);
    out.n_parameters += std::max<std::size_t>(values.size(), 1);
    out.parameters.push_back(std::move(values));
    out.implausible.push_back(implausible(fit, whole, kind, decays_.rate_hz));
  }
  return out;
}

ResponseFit FreeDecayModel::describe(const FreeDecayFit& fit, const State& state,
                                     const std::vector<State>& without) const {
  ResponseFit out;
  double squares = 0.0, n = 0.0, heldout = 0.0, early = 0.0, n_early = 0.0;
  for (std::size_t r = 0; r < decays_.release.size(); ++r) {
    const MatrixXd residual = fit.residual(state, r);
    const Index third = residual.rows() / 3;
    out.fold_squares.push_back(fit.residual(without[r], r).squaredNorm());
    heldout += out.fold_squares.back();
    squares += residual.squaredNorm();
    early += residual.topRows(third).squaredNorm();
    n += static_cast<double>(residual.size());
    n_early += static_cast<double>(residual.topRows(third).size());
  }
  out.residual_rms = std::sqrt(squares / n);
  out.heldout_rms = std::isfinite(heldout) ? std::sqrt(heldout / n) : std::numeric_limits<double>::infinity();
  out.noise_floor = decays_.noise_rms;
  out.noise_variance = std::max(squares / n, 1e-300);
  out.structured = out.residual_rms > kMoreThanNoise * out.noise_floor;
  out.words = "the residual is " + number(out.residual_rms) + " " + decays_.unit +
              " rms, the noise before the release is " + number(out.noise_floor);
  out.left = number(std::sqrt(early / std::max(n_early, 1.0))) + " " + decays_.unit +
             " rms in the first third of the decays, " +
             number(std::sqrt((squares - early) / std::max(n - n_early, 1.0))) + " after it";
  const DecayRates rates = fit.rates(state, 0.0);
  const double w = 2.0 * std::numbers::pi * rates.frequency_hz, rate = std::exp(rates.log_rate);
  ClosureMode mode;
  mode.number = 1;
  mode.frequency_hz = rates.frequency_hz;
  mode.damping_ratio = rate / std::hypot(w, rate);
  out.modes.push_back(mode);
  return out;
}

std::unique_ptr<ResponseModel> FreeDecayModel::surrogate(const std::vector<std::string>& effects,
                                                         std::uint64_t seed) const {
  const FreeDecayFit fit(decays_, by_names(effects));
  const State& state = state_of(effects);
  double squares = 0.0, n = 0.0;
  for (std::size_t r = 0; r < decays_.release.size(); ++r) {
    squares += fit.residual(state, r).squaredNorm();
    n += static_cast<double>(decays_.release[r].size());
  }
  const double scatter = std::sqrt(squares / n);
  NoiseStream noise(seed);
  FreeDecays made = decays_;
  for (std::size_t r = 0; r < made.release.size(); ++r) {
    made.release[r] = fit.predicted(state, r);
    for (Index c = 0; c < made.release[r].cols(); ++c) {
      for (Index k = 0; k < made.release[r].rows(); ++k) made.release[r](k, c) += scatter * noise.gaussian();
    }
  }
  auto out = std::make_unique<FreeDecayModel>(std::move(made));
  out->made_up_ = true;
  out->states_.emplace(effects, state);
  return out;
}

}  // namespace core::closure
