#include "core/closure/closure_loop.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

namespace core::closure {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
constexpr double kTie = 0.01;                 // of the score: as good as equal
constexpr double kPlain = 3.0;                // times what few surrogates say of chance
constexpr std::size_t kAdoptionsPerStep = 2;  // at most, where effects become needless
constexpr std::size_t kRevertsPerStep = 3;    // at most, where the best candidates fail in the refit
constexpr double kKeptOfScore = 0.5;          // a refit must keep so much of the predicted drop in held-out squares

class Loop {
 public:
  Loop(ClosureLevel& level, const ClosureOptions& options) : level_(level), options_(options) {}

  ClosureResult run() {
    start();
    while (step()) {
    }
    finish();
    return std::move(result_);
  }

 private:
  struct Reverted {
    EffectId id;
    std::string reason;
  };

  void start() {
    tell("fitting the model without effects");
    result_.level = level_.name();
    result_.unit = level_.unit();
    fit_ = level_.fit();
    result_.baseline_rms = fit_.residual_rms;
    result_.noise_floor = fit_.noise_floor;
    result_.modes_before = level_.modes();
    result_.reference_error_before = level_.reference_error();
    result_.reference_unit = level_.reference_unit();
  }

  bool step() {
    if (!fit_.structured) return stop(fit_.words);
    if (result_.steps.size() >= options_.max_steps || n_adoptions_ >= kAdoptionsPerStep * options_.max_steps)
      return stop("the largest allowed number of effects is adopted");
    if (level_.candidates().empty()) return stop("no candidate is left; " + fit_.words);
    tell("scoring the candidates of step " + std::to_string(result_.steps.size() + 1));
    std::vector<CandidateScore> scores = level_.score();
    refuse_reverted(scores);
    result_.refused = ranked(scores, kNone);
    const std::size_t best = best_of(scores);
    if (best == kNone) {
      return stop(reverted_.empty() ? "no candidate lowers the held-out error materially and plausibly"
                                    : reverted_.back().reason);
    }
    const double threshold = threshold_of_step(scores[best].score);
    if (!(scores[best].score > threshold)) {
      for (CandidateScore& score : result_.refused) {
        if (score.refusal.empty()) score.refusal = "does not exceed the chance threshold";
      }
      return stop("the best candidate, " + scores[best].effect + ", does not exceed the chance threshold");
    }
    return adopt(scores, best, threshold);
  }

  bool adopt(const std::vector<CandidateScore>& scores, std::size_t best, double threshold) {
    const LevelFit before = fit_;
    level_.adopt(best);
    fit_ = level_.fit();
    const double predicted = before.heldout * before.heldout - scores[best].heldout * scores[best].heldout;
    const bool from_nothing = std::isinf(before.heldout) && std::isfinite(fit_.heldout);
    const double reached = drop(before, fit_);
    if (!from_nothing && !keeps(reached, predicted)) return take_back(scores[best], predicted);
    if (!from_nothing && options_.least_gain > 0.0 && size_of_adopted(reached) < options_.least_gain) {
      level_.drop();
      fit_ = level_.fit();
      return stop("the best candidate, " + scores[best].effect + ", is smaller than the smallest effect asked for");
    }
    ClosureStep step;
    step.effect = scores[best].effect;
    step.id = scores[best].id;
    step.kind = scores[best].kind;
    step.heldout_before = before.heldout;
    step.heldout_after = fit_.heldout;
    step.score = scores[best].score;
    step.threshold = threshold;
    step.others = ranked(scores, best);
    result_.steps.push_back(std::move(step));
    result_.refused.clear();
    reverted_.clear();
    retried_.clear();
    ++n_adoptions_;
    remove_needless();
    return true;
  }

  [[nodiscard]] double size_of_adopted(double drop_of_squares) const {
    return std::max(std::sqrt(std::max(drop_of_squares, 0.0)), level_.size_of(result_.steps.size()));
  }

  void remove_needless() {
    while (const std::optional<std::size_t> needless = level_.drop_needless())
      remove(*needless, "those after it explain what it explained");
  }

  // The level has dropped it.
  void remove(std::size_t step, const std::string& reason) {
    tell(result_.steps.at(step).effect + " is removed: " + reason);
    result_.steps.erase(result_.steps.begin() + static_cast<std::ptrdiff_t>(step));
    fit_ = level_.fit();
  }

  [[nodiscard]] double threshold_of_step(double best) {
    std::vector<double> scores;
    for (std::size_t i = 0; i < options_.n_surrogates; ++i) {
      tell("surrogates of step " + std::to_string(result_.steps.size() + 1), i, options_.n_surrogates);
      scores.push_back(level_.surrogate_score(next_seed()));
      if (scores.size() == options_.n_surrogates_when_plain && best > kPlain * chance_threshold(scores)) break;
    }
    result_.n_surrogates += scores.size();
    return chance_threshold(std::move(scores));
  }

  [[nodiscard]] static std::size_t best_of(const std::vector<CandidateScore>& scores) {
    std::size_t best = kNone;
    for (std::size_t i = 0; i < scores.size(); ++i) {
      const CandidateScore& s = scores[i];
      if (!s.refusal.empty() || !std::isfinite(s.score) || !(s.score > 0.0)) continue;
      if (best == kNone) {
        best = i;
        continue;
      }
      const double tie = kTie * std::max(s.score, scores[best].score);
      const bool equal = std::abs(s.score - scores[best].score) <= tie && s.n_parameters != scores[best].n_parameters;
      if (equal ? s.n_parameters < scores[best].n_parameters : s.score > scores[best].score) best = i;
    }
    return best;
  }

  // All scores except `without`, best first; adoptable candidates precede refused ones.
  [[nodiscard]] static std::vector<CandidateScore> ranked(std::vector<CandidateScore> scores, std::size_t without) {
    if (without != kNone) scores.erase(scores.begin() + static_cast<std::ptrdiff_t>(without));
    for (CandidateScore& s : scores) {
      if (std::isnan(s.score)) s.score = -std::numeric_limits<double>::infinity();
    }
    std::stable_sort(scores.begin(), scores.end(), [](const CandidateScore& a, const CandidateScore& b) {
      if (a.refusal.empty() != b.refusal.empty()) return a.refusal.empty();
      return a.score > b.score;
    });
    return scores;
  }

  // Of the held-out squares.
  [[nodiscard]] static double drop(const LevelFit& without, const LevelFit& with) {
    return without.heldout * without.heldout - with.heldout * with.heldout;
  }
  [[nodiscard]] static bool keeps(double reached, double predicted) {
    return reached > 0.0 && reached >= kKeptOfScore * predicted;
  }

  // The next best candidate is tried in its place. A level may measure its noise again when an effect is adopted; the
  // fits before and after cannot be compared then, and the same candidate is scored once more with the new noise.
  bool take_back(const CandidateScore& effect, double predicted) {
    const LevelFit with = fit_;
    level_.drop();
    fit_ = level_.fit();
    const bool noise_changed = keeps(drop(fit_, with), predicted);
    const bool tried = std::find(retried_.begin(), retried_.end(), effect.id) != retried_.end();
    if (noise_changed && !tried) {
      retried_.push_back(effect.id);
      return true;
    }
    reverted_.push_back(
        {effect.id, effect.effect + " was reverted: the held-out error did not fall when all effects were refitted"});
    return reverted_.size() < kRevertsPerStep || stop(reverted_.back().reason);
  }

  void refuse_reverted(std::vector<CandidateScore>& scores) const {
    for (CandidateScore& score : scores) {
      for (const Reverted& reverted : reverted_) {
        if (score.id == reverted.id && score.refusal.empty()) score.refusal = reverted.reason;
      }
    }
  }

  bool stop(const std::string& reason) {
    result_.stop_reason = reason;
    return false;
  }

  void finish() {
    while (const std::optional<std::size_t> pretended = level_.drop_pretended())
      remove(*pretended, "a motion that the model leaves free explains what it explained");
    for (std::size_t i = 0; i < result_.steps.size(); ++i) {
      tell("looking for rivals of " + result_.steps[i].effect);
      result_.steps[i].parameters = level_.parameters(i);
      result_.steps[i].meaning = level_.meaning(i);
      result_.steps[i].rivals = level_.rivals(i, next_seed());
    }
    for (ClosureStep& step : level_.absorbed()) {
      step.is_absorbed = true;
      step.heldout_before = step.heldout_after = fit_.heldout;
      result_.steps.push_back(std::move(step));
    }
    result_.residual_rms = fit_.residual_rms;
    result_.modes_after = level_.modes();
    result_.reference_error_after = level_.reference_error();
    result_.not_observable = level_.not_observable();
    ClosureLevel::Noise noise = level_.noise();
    result_.noise = std::move(noise.values), result_.noise_advice = std::move(noise.advice);
    const auto excess = [&](double rms) { return std::max(rms * rms - fit_.noise_floor * fit_.noise_floor, 0.0); };
    const double whole = excess(result_.baseline_rms);
    if (fit_.structured)
      result_.unexplained_fraction = whole > 0.0 ? std::min(excess(fit_.residual_rms) / whole, 1.0) : 0.0;
    result_.unexplained = fit_.structured ? level_.describe_residual() : "nothing: " + fit_.words;
  }

  // Never repeats within a run. splitmix64's constant separates the streams of runs with different seeds.
  [[nodiscard]] std::uint64_t next_seed() noexcept { return options_.seed * 0x9e3779b97f4a7c15ULL + n_drawn_++; }

  void tell(const std::string& words, std::size_t n_done = 0, std::size_t n = 0) const {
    if (options_.progress) options_.progress({words, n_done, n});
  }

  ClosureLevel& level_;
  const ClosureOptions& options_;
  ClosureResult result_;
  LevelFit fit_;
  std::uint64_t n_drawn_ = 0;
  std::size_t n_adoptions_ = 0;     // with those that became needless
  std::vector<Reverted> reverted_;  // since the last adoption
  std::vector<EffectId> retried_;   // with noise measured again
};

}  // namespace

double chance_threshold(std::vector<double> scores) {
  const auto n = static_cast<double>(scores.size());
  const auto k = static_cast<std::size_t>(std::floor(kChance * (n + 1.0) + 1e-9));
  if (k > 0) {
    std::nth_element(scores.begin(), scores.begin() + static_cast<std::ptrdiff_t>(k - 1), scores.end(),
                     std::greater<>());
    return scores[k - 1];
  }
  const double mean = std::accumulate(scores.begin(), scores.end(), 0.0) / n;
  double squares = 0.0;
  for (const double s : scores) squares += (s - mean) * (s - mean);
  const double deviation = std::sqrt(squares / std::max(n - 1.0, 1.0));
  const double gumbel = -std::log(-std::log(1.0 - kChance));  // quantile of the standard Gumbel distribution
  return mean + deviation * std::sqrt(6.0) / std::numbers::pi * (gumbel - std::numbers::egamma);
}

ClosureResult close_loop(ClosureLevel& level, const ClosureOptions& options) {
  if (options.n_surrogates < 8) {
    throw std::invalid_argument("surrogates: " + std::to_string(options.n_surrogates) +
                                " are too few for a chance threshold; use 333 or more (8 at least)");
  }
  return Loop(level, options).run();
}

}  // namespace core::closure
