// StructureLevel: what chance gives, by surrogates, and which effects explain the data as well.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/closure/closure_loop.h"
#include "core/closure/noise_stream.h"
#include "core/closure/structure_level.h"
#include "core/closure/structure_words.h"

namespace core::closure {

using structure::FrameFit;
using structure::FrameModel;
using structure::LeaveOneOut;
using structure::ReferenceMode;
using structure::Starts;

namespace {

constexpr std::size_t kRivalSurrogates = 333;
constexpr std::uint64_t kDirectionDraws = 3333;  // the tenth largest is the 99.7 % level
constexpr std::uint64_t kDirectionSeed = 34;

// Data of a fitted model with noise, in sigmas; priors have none.
Eigen::VectorXd noisy(const FrameFit& fit, Eigen::Index n_priors, double spread, std::uint64_t seed) {
  Eigen::VectorXd out(fit.n_data);
  NoiseStream noise(seed);
  for (Eigen::Index i = 0; i < out.size() - n_priors; ++i) out(i) = spread * noise.gaussian();
  out.tail(n_priors) = fit.residuals.tail(n_priors);
  return out;
}

// The same modes under the numbers of another model.
std::vector<ReferenceMode> as_in(const std::vector<ReferenceMode>& numbers, std::vector<ReferenceMode> data) {
  for (std::size_t i = 0; i < data.size(); ++i) data[i].number = numbers[i].number;
  return data;
}

}  // namespace

// Tests the residual along the effects at their places, which has more power against one of them than chi-square
// over all data.
bool StructureLevel::is_like_an_effect() const {
  if (!first_order_) return false;
  const auto n_priors = static_cast<Eigen::Index>(model_.with_prior().size());
  std::vector<double> gains;
  for (std::uint64_t i = 0; i < kDirectionDraws; ++i)
    gains.push_back(first_order_->largest_gain(noisy(fit_, n_priors, 1.0, kDirectionSeed * 1000003ULL + i)));
  return first_order_->largest_gain(fit_.residuals) > chance_threshold(std::move(gains));
}

// `out`: the reference under the model's numbers.
StructureLevel::Reference StructureLevel::surrogate(const FrameModel& model, const FrameFit& fit, Reference out,
                                                    double spread, std::uint64_t seed) {
  const auto modes = seen_modes(model, fit.parameters, true);
  if (!modes) return out;
  NoiseStream noise(seed);
  for (ReferenceMode& mode : out) {
    const double relative = relative_sigma(mode);
    mode.frequency_hz =
        modes->frequency_hz(mode.number - 1) * std::max(1.0 + spread * relative * noise.gaussian(), 0.1);
    mode.sigma_hz = relative * mode.frequency_hz;
    for (std::size_t i = 0; i < mode.shape.size(); ++i) {
      mode.shape[i] = modes->shapes(static_cast<Eigen::Index>(i), mode.number - 1) +
                      spread * mode.shape_sigma[i] * noise.gaussian();
    }
  }
  return out;
}

double StructureLevel::surrogate_score(std::uint64_t seed) {
  if (!first_order_) return fitted_surrogate_score(seed);
  return first_order_->largest_score(noisy(fit_, static_cast<Eigen::Index>(model_.with_prior().size()), 1.0, seed));
}

double StructureLevel::fitted_surrogate_score(std::uint64_t seed) const {
  const Reference data = surrogate(model_, fit_, reference_, 1.0, seed);
  const FrameFit plain = fit_frame(model_, data, fit_.parameters, Starts::kBest);
  const double before = leave_one_out(model_, data, plain).chi2;
  double best = 0.0;
  for (const Effect effect : open()) {
    const FrameModel model = with(effect);
    const FrameFit fit = fit_frame(model, data, plain.parameters, Starts::kBest);
    const double after = leave_one_out(model, data, fit).chi2;
    if (std::isfinite(before) && std::isfinite(after)) best = std::max(best, before - after);
  }
  return best;
}

// Tests whether data simulated from the rival favour the adopted model by as much as the reference does (Cox 1961, with
// surrogates).
bool StructureLevel::is_rival(const FrameModel& rival, std::uint64_t seed) const {
  FrameFit fit = fit_frame(rival, reference_, {}, Starts::kAll);
  const std::optional<Reference> renumbered = under_own_numbers(rival, fit);
  if (renumbered) fit = fit_frame(rival, *renumbered, {}, Starts::kAll);
  const Reference& reference = renumbered ? *renumbered : reference_;
  const LeaveOneOut loo = leave_one_out(rival, reference, fit);
  if (!fit.ok || !std::isfinite(loo.chi2) || !implausible(rival, fit).empty()) return false;
  const double difference = loo.chi2 - loo_.chi2;
  if (difference <= 0.0) return true;
  const double noise = spread(), freedom = fit.degrees_of_freedom();
  if (freedom > 0.0 && fit.chi2 > noise * noise * structure::chi2_limit(freedom)) return false;
  std::vector<double> chance =
      declared_.model ? first_order_differences(rival, fit, reference, seed) : std::vector<double>{};
  if (chance.empty()) chance = differences(rival, fit, reference, seed);
  return !chance.empty() && difference <= chance_threshold(std::move(chance));
}

// By how much surrogates of the fitted rival favour the adopted model.
std::vector<double> StructureLevel::differences(const FrameModel& rival, const FrameFit& fit,
                                                const Reference& reference, std::uint64_t seed) const {
  std::vector<double> out;
  for (std::size_t i = 0; i < kRivalSurrogates; ++i) {
    const Reference data = surrogate(rival, fit, reference, spread(), seed * 1000003ULL + i);
    const Reference renumbered = as_in(reference_, data);
    const FrameFit own = fit_frame(rival, data, fit.parameters, Starts::kBest);
    const FrameFit other = fit_frame(model_, renumbered, fit_.parameters, Starts::kBest);
    const double gap = leave_one_out(rival, data, own).chi2 - leave_one_out(model_, renumbered, other).chi2;
    if (std::isfinite(gap)) out.push_back(gap);
  }
  return out;
}

// The same with both models linear about their fits to the rival's data without noise. Empty: cannot be formed.
std::vector<double> StructureLevel::first_order_differences(const FrameModel& rival, const FrameFit& fit,
                                                            const Reference& reference, std::uint64_t seed) const {
  const Reference exact = as_in(reference_, surrogate(rival, fit, reference, 0.0, seed));
  const FrameFit other = fit_frame(model_, exact, fit_.parameters, Starts::kBest);
  const auto own_held = structure::HeldOutModes::about(rival, reference, fit);
  const auto other_held = structure::HeldOutModes::about(model_, exact, other);
  std::vector<double> out;
  if (!own_held || !other_held) return out;
  const auto n_priors = static_cast<Eigen::Index>(model_.with_prior().size());
  for (std::size_t i = 0; i < kRivalSurrogates; ++i) {
    const Eigen::VectorXd own = noisy(fit, n_priors, spread(), seed * 1000003ULL + i);
    Eigen::VectorXd both = own + other.residuals;
    both.tail(n_priors) = other.residuals.tail(n_priors);
    out.push_back(own_held->chi2(own_held->fitted_residuals(own)) -
                  other_held->chi2(other_held->fitted_residuals(both)));
  }
  return out;
}

std::vector<std::string> StructureLevel::rivals(std::size_t adopted, std::uint64_t seed) {
  std::vector<std::string> out;
  for (const Effect effect : open()) {
    FrameModel rival = model_;
    rival.effects.erase(rival.effects.begin() + static_cast<std::ptrdiff_t>(adopted));
    rival.effects.push_back(effect);
    if (is_rival(rival, seed)) out.emplace_back(effect->name());
  }
  return out;
}

}  // namespace core::closure
