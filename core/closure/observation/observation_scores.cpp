#include "core/closure/observation/observation_scores.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>

#include "core/closure/observation/block_estimates.h"
#include "core/closure/observation/kinds/latent_pattern.h"
#include "core/closure/observation/kinds/materiality.h"
#include "core/closure/observation/remainder.h"

namespace core::closure {
namespace {

constexpr double kSignStretch_s = 2.0;

// Residual with the series of each point shifted in time. A steady sine would stay coherent over the points after a
// shift alone; random signs per stretch of time remove this coherence.
Eigen::MatrixXd shuffled(const Eigen::MatrixXd& residual, double rate_hz, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const Eigen::Index n = residual.cols();
  Eigen::MatrixXd shifted(residual.rows(), n);
  for (Eigen::Index j = 0; j < residual.rows() / 2; ++j) {
    const auto lag = static_cast<Eigen::Index>(engine() % static_cast<std::uint64_t>(n));
    shifted.middleRows(2 * j, 2).leftCols(n - lag) = residual.middleRows(2 * j, 2).rightCols(n - lag);
    shifted.middleRows(2 * j, 2).rightCols(lag) = residual.middleRows(2 * j, 2).leftCols(lag);
  }
  const auto stretch = std::max<Eigen::Index>(8, static_cast<Eigen::Index>(kSignStretch_s * rate_hz));
  for (Eigen::Index j = 0; j < residual.rows() / 2; ++j) {
    for (Eigen::Index from = 0; from < n; from += stretch) {
      if (engine() % 2 == 0) shifted.block(2 * j, from, 2, std::min(stretch, n - from)) *= -1.0;
    }
  }
  return shifted;
}

// Which adopted effect leaves this candidate's pattern of itself, in words; empty: none.
std::string left_by_adopted(const EffectCandidate& candidate, const Remainders& remainders) {
  const std::unique_ptr<EffectInModel> found = candidate.adopted();
  if (found->pattern() == nullptr) return {};
  const std::optional<Remainder> remainder = remainders.find(*found->pattern(), found->band());
  if (!remainder) return {};
  std::array<char, 16> percent{};
  (void)std::snprintf(percent.data(), percent.size(), "%.1f", 100.0 * remainder->share);
  return "what " + remainder->effect + " leaves of itself: " + percent.data() + " % of it, at its frequencies";
}

}  // namespace

void ObservationScores::begin() {
  prepared_.clear();
  left_squares_.reset();
  is_prepared_ = is_scored_ = false;
}

std::vector<const ObservationEffect*> ObservationScores::open() const {
  std::vector<const ObservationEffect*> out;
  for (const ObservationEffect* effect : catalogue_) {
    const bool taken = std::any_of(fit_.effects().begin(), fit_.effects().end(),
                                   [&](const auto& adopted) { return adopted->id() == effect->id(); });
    if (!taken) out.push_back(effect);
  }
  return out;
}

std::size_t ObservationScores::n_latent() const {
  return static_cast<std::size_t>(std::count_if(fit_.effects().begin(), fit_.effects().end(), [](const auto& adopted) {
    return adopted->kind() == EffectKind::kLatent;
  }));
}

std::vector<std::string> ObservationScores::candidates() const {
  std::vector<std::string> names;
  for (const ObservationEffect* effect : open()) names.push_back(effect->name());
  if (n_latent() < kMostLatent) names.push_back(latent_name(n_latent() + 1));
  return names;
}

void ObservationScores::prepare() {
  if (is_prepared_) return;
  const FitView view = fit_.view();
  for (const ObservationEffect* effect : open()) prepared_.push_back(effect->candidate(view));
  if (n_latent() < kMostLatent) prepared_.push_back(latent_candidate(n_latent() + 1, view));
  is_prepared_ = true;
}

double ObservationScores::left_squares() const {
  const FitView view = fit_.view();
  return left_squares_ ? *left_squares_ : left_squares_.emplace(view.held_out.squares(view.model.residual()));
}

LevelFit ObservationScores::quality() const {
  const FitView view = fit_.view();
  const double n_values = view.held_out.n_values(), freedom = fit_.freedom_beside();
  LevelFit out;
  const double squares = left_squares() + 2.0 * freedom;
  out.heldout = view.sigma_px * std::sqrt(squares / n_values);
  out.noise_floor = view.sigma_px * std::sqrt(view.held_out.noise_variance() + freedom / n_values);
  out.residual_rms = out.heldout;
  out.structured = true;  // surrogates determine what noise can reach
  out.words =
      "held-out residual is " + std::to_string(out.heldout / out.noise_floor) + " of the floor of the measured noise";
  if (!std::isfinite(out.heldout)) throw std::runtime_error("observation level: the fit did not stay finite");
  return out;
}

// Empty: the gain is material.
std::string ObservationScores::smallness(const EffectCandidate& candidate, double gain, double above_noise) const {
  if (!(gain > candidate.material_share() * fit_.view().held_out.n_values())) return "immaterial";
  const double least = candidate.is_learned() ? kLearnedOfExcess : kNamedOfExcess;
  return gain > least * above_noise ? std::string() : "explains too little of what exceeds the noise";
}

Objection ObservationScores::refusal(const EffectCandidate& candidate, double gain, const TestedResidual& tested,
                                     const Unexplained& unexplained) const {
  std::string small = smallness(candidate, gain, unexplained.above_noise);
  if (!small.empty()) return {std::move(small)};
  const double free_gain = candidate.free_gain(tested).value_or(unexplained.by_learned);
  const double family_gain = candidate.free_gain(tested) ? gain : std::max(gain, unexplained.by_constants);
  if (family_gain < kOfLearned * free_gain || gain < kOfFamily * free_gain) {
    return {"a projection of another effect: it explains " + std::to_string(std::lround(100.0 * gain / free_gain)) +
            " % of what the best learned pattern explains"};
  }
  return candidate.objection(tested);
}

// Of all constants that are still open, together: those of a lens share what one pattern explains.
double ObservationScores::constants_gain(const TestedResidual& tested) const {
  std::vector<const CompactField*> fields;
  for (const auto& candidate : prepared_) {
    const std::span<const CompactField* const> own = candidate->constant_fields();
    fields.insert(fields.end(), own.begin(), own.end());
  }
  return fields.empty() ? 0.0 : BlockEstimates(fields, fit_.view().held_out.errors_of(tested.values)).held_out_gain();
}

std::vector<CandidateScore> ObservationScores::score() {
  prepare();
  const FitView view = fit_.view();
  const Eigen::MatrixXd& residual = view.model.residual();
  const ResidualMoments moments = residual_moments(residual, view.record.rate_hz);
  const TestedResidual tested{residual, moments};
  const Remainders remainders(fit_, moments);
  const std::vector<const ObservationEffect*> named = open();
  const double n_values = view.held_out.n_values(), freedom = fit_.freedom_beside();
  const double left = left_squares(), squares = left + 2.0 * freedom;
  const PatternGain learned = view.held_out.of_learned(moments);
  const bool is_material = learned.gain > material_of(learned.band, view, kLearnedBar) * n_values;
  const Unexplained unexplained{left - view.held_out.noise_variance() * n_values, is_material ? learned.gain : 0.0,
                                constants_gain(tested)};
  const auto scored = [&](std::size_t i, EffectId id, std::string name) {
    CandidateScore s;
    s.id = std::move(id), s.effect = std::move(name);
    s.score = prepared_[i]->find(tested);
    s.heldout = view.sigma_px * std::sqrt(std::max(squares - s.score, 0.0) / n_values);
    return s;
  };
  is_other_cause_.assign(prepared_.size(), 0);
  std::vector<CandidateScore> out;
  for (std::size_t i = 0; i < named.size(); ++i) {
    CandidateScore s = scored(i, named[i]->id(), named[i]->name());
    s.n_parameters = named[i]->n_parameters();
    Objection objection = refusal(*prepared_[i], s.score, tested, unexplained);
    s.refusal = std::move(objection.words);
    if (s.refusal.empty()) s.refusal = left_by_adopted(*prepared_[i], remainders);
    is_other_cause_[i] = objection.is_other_cause ? 1 : 0;
    out.push_back(std::move(s));
  }
  refuse_unspecific(out, unexplained.by_constants);
  if (prepared_.size() > named.size()) {
    const bool is_explained =
        std::any_of(out.begin(), out.end(), [](const CandidateScore& other) { return other.refusal.empty(); });
    CandidateScore s = scored(named.size(), latent_id(n_latent() + 1), latent_name(n_latent() + 1));
    s.kind = EffectKind::kLatent, s.n_parameters = 1;
    s.refusal = is_explained         ? "a named effect explains it"
                : fit_.hides_noise() ? "cannot be distinguished from what a random field leaves"
                                     : smallness(*prepared_.back(), s.score, unexplained.above_noise);
    if (s.refusal.empty()) s.refusal = left_by_adopted(*prepared_.back(), remainders);
    out.push_back(std::move(s));
  }
  is_scored_ = true;
  return out;
}

void ObservationScores::refuse_unspecific(std::vector<CandidateScore>& scores, double by_constants) const {
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (!prepared_[i]->is_unspecific() || !scores[i].refusal.empty()) continue;
    double best = by_constants;
    std::string of = "constants";
    for (std::size_t k = 0; k < scores.size(); ++k) {
      if (k != i && scores[k].score > best) best = scores[k].score, of = scores[k].effect;
    }
    if (best < kOfUnspecific * scores[i].score) continue;
    scores[i].refusal = of + " explains " + std::to_string(std::lround(100.0 * best / scores[i].score)) + " % of it";
  }
}

double ObservationScores::surrogate_score(std::uint64_t seed) {
  prepare();
  const FitView view = fit_.view();
  const Eigen::MatrixXd& residual = view.model.residual();
  Eigen::MatrixXd left = view.model.left_of(shuffled(residual, view.record.rate_hz, seed));
  const double norm = left.norm();
  if (norm > 0.0) left *= residual.norm() / norm;
  const ResidualMoments moments = residual_moments(left, view.record.rate_hz);
  double best = view.held_out.of_learned(moments).gain;
  for (std::size_t i = 0; i < open().size(); ++i) best = std::max(best, prepared_[i]->gain({left, moments}));
  return best;
}

std::unique_ptr<EffectInModel> ObservationScores::adopted(std::size_t candidate) {
  if (!is_scored_) (void)score();
  if (candidate >= prepared_.size()) throw std::invalid_argument("no candidate " + std::to_string(candidate));
  return prepared_[candidate]->adopted();
}

bool ObservationScores::refines(const EffectId& higher, const EffectId& lower) const {
  return std::any_of(catalogue_.begin(), catalogue_.end(),
                     [&](const ObservationEffect* effect) { return effect->id() == higher && effect->refines(lower); });
}

std::vector<std::string> ObservationScores::as_good_as(const EffectId& id) {
  const std::vector<CandidateScore> scores = score();
  double of_own = std::numeric_limits<double>::infinity();
  for (const CandidateScore& s : scores) {
    if (s.id == id) of_own = s.score;
  }
  std::vector<std::string> out;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const CandidateScore& s = scores[i];
    if (s.id != id && s.kind == EffectKind::kNamed && s.score >= kRival * of_own && is_other_cause_[i] == 0 &&
        !refines(s.id, id))
      out.push_back(s.effect);
  }
  return out;
}

}  // namespace core::closure
