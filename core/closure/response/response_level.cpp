#include "core/closure/response/response_level.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/closure/structure_words.h"

namespace core::closure {
namespace {

double score_of(const ResponseFit& before, const ResponseFit& after) {
  if (!std::isfinite(after.heldout_rms) || !(before.noise_variance > 0.0))
    return -std::numeric_limits<double>::infinity();
  return (before.heldout_squares() - after.heldout_squares()) / before.noise_variance;
}

// Sum of the differences b - a over the left-out parts, in standard errors.
double difference_in_errors(const ResponseFit& a, const ResponseFit& b) {
  const std::size_t n = std::min(a.fold_squares.size(), b.fold_squares.size());
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < n; ++i) sum += b.fold_squares[i] - a.fold_squares[i];
  const double mean = n > 0 ? sum / static_cast<double>(n) : 0.0;
  for (std::size_t i = 0; i < n; ++i) squares += std::pow(b.fold_squares[i] - a.fold_squares[i] - mean, 2);
  if (n < 2 || !(squares > 0.0)) return sum > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
  return sum / std::sqrt(squares * static_cast<double>(n) / static_cast<double>(n - 1));
}

// Names an effect all of whose parameters lie within three standard deviations of zero; empty: at least one does not,
// or has no sigma.
std::string not_from_zero(const std::vector<ParameterValue>& parameters) {
  std::string numbers;
  for (const ParameterValue& p : parameters) {
    if (!p.sigma || (p.value != 0.0 && std::abs(p.value) >= ResponseLevel::kFromZero * *p.sigma)) return {};
    numbers += (numbers.empty() ? "" : ", ") + number(p.value) + " +- " + number(*p.sigma) + " " + p.unit;
  }
  return numbers.empty() ? "" : "cannot be distinguished from zero: " + numbers;
}

}  // namespace

std::vector<std::string> ResponseLevel::candidates() const {
  std::vector<std::string> out;
  for (std::string& effect : model_.effects()) {
    if (std::find(adopted_.begin(), adopted_.end(), effect) == adopted_.end()) out.push_back(std::move(effect));
  }
  return out;
}

std::vector<std::string> ResponseLevel::with(const std::string& effect) const {
  std::vector<std::string> effects = adopted_;
  effects.push_back(effect);
  return effects;
}

LevelFit ResponseLevel::fit() {
  fit_ = model_.fit(adopted_);
  LevelFit out;
  out.residual_rms = fit_.residual_rms;
  out.noise_floor = fit_.noise_floor;
  out.heldout = fit_.heldout_rms;
  out.structured = fit_.structured;
  out.words = fit_.words;
  return out;
}

std::string ResponseLevel::refusal(const std::string& effect, const ResponseFit& fit) const {
  if (!std::isfinite(fit.heldout_rms)) return "cannot be fitted to parts of this record";
  for (std::size_t i = 0; i < fit.implausible.size(); ++i) {
    if (!fit.implausible[i].empty()) return "implausible: " + fit.implausible[i];
  }
  for (const auto& parameters : fit.parameters) {
    if (const std::string words = not_from_zero(parameters); !words.empty()) return words;
  }
  const double before = fit_.heldout_squares(), after = fit.heldout_squares();
  if (after >= before) return "does not lower the held-out error";
  if (before - after < model_.material_share(effect) * before) return "lowers the held-out error immaterially";
  return {};
}

std::vector<CandidateScore> ResponseLevel::score() {
  std::vector<CandidateScore> out;
  for (const std::string& effect : candidates()) {
    const ResponseFit fit = model_.fit(with(effect));
    CandidateScore score;
    score.effect = effect, score.id = {effect};
    score.n_parameters = fit.n_parameters - fit_.n_parameters;
    score.heldout = fit.heldout_rms;
    score.score = score_of(fit_, fit);
    score.refusal = refusal(effect, fit);
    out.push_back(std::move(score));
  }
  return out;
}

double ResponseLevel::surrogate_score(std::uint64_t seed) {
  const std::unique_ptr<ResponseModel> made = model_.surrogate(adopted_, seed);
  const ResponseFit plain = made->fit(adopted_);
  double best = 0.0;
  for (const std::string& effect : candidates()) best = std::max(best, score_of(plain, made->fit(with(effect))));
  return best;
}

std::vector<ParameterValue> ResponseLevel::parameters(std::size_t adopted) const { return fit_.parameters.at(adopted); }

std::vector<std::string> ResponseLevel::rivals(std::size_t adopted, std::uint64_t /*seed*/) {
  std::vector<std::string> out;
  for (const std::string& effect : candidates()) {
    std::vector<std::string> effects = adopted_;
    effects.at(adopted) = effect;
    const ResponseFit fit = model_.fit(effects);
    const bool plausible =
        std::all_of(fit.implausible.begin(), fit.implausible.end(), [](const auto& words) { return words.empty(); });
    // A rival whose own parameters are not significant explains nothing.
    const bool is_there = std::all_of(fit.parameters.begin(), fit.parameters.end(),
                                      [](const auto& parameters) { return not_from_zero(parameters).empty(); });
    const bool alike = fit.heldout_rms <= kRivalRms * fit_.heldout_rms;
    if (plausible && is_there && alike && difference_in_errors(fit_, fit) <= kRivalErrors) out.push_back(effect);
  }
  return out;
}

}  // namespace core::closure
