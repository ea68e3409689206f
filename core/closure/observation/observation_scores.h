#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/closure/closure_level.h"
#include "core/closure/observation/effect.h"
#include "core/closure/observation/observation_fit.h"

namespace core::closure {

// Scores of the candidates on one fit. Cross-validation leaves one point out in closed form (HeldOut); constants are
// fitted to nine of ten time blocks and scored on the tenth; latent patterns are learned on four of five parts. Score =
// decrease of held-out squares in noise variances; share = score / number of residual values, the unit of the
// materiality thresholds.
class ObservationScores {
 public:
  // A named effect must reach this share of the gain of the best pattern learned from the residual itself, in the same
  // place and band where the effect has one; otherwise it is a projection of another effect.
  // Of constants: they together, and each of them a part.
  static constexpr double kOfLearned = 0.8, kOfFamily = 0.1;
  static constexpr double kRival = 0.9;         // of the score of the effect in whose place it stands
  static constexpr double kOfUnspecific = 0.5;  // of an unspecific effect's score, by one that is specific
  static constexpr std::size_t kMostLatent = 8;

  // Both arguments must outlive the object.
  ObservationScores(const ObservationFit& fit, const std::vector<const ObservationEffect*>& catalogue)
      : fit_(fit), catalogue_(catalogue) {}

  // Forgets the candidates of the last solution; call it before each solve() of the fit.
  void begin();
  [[nodiscard]] LevelFit quality() const;

  [[nodiscard]] std::vector<std::string> candidates() const;  // names for the current set of adopted effects
  [[nodiscard]] std::vector<CandidateScore> score();
  // The largest gain on a residual without an effect: the series of each point is shifted in time by its own lag, with
  // a random sign for every two seconds.
  [[nodiscard]] double surrogate_score(std::uint64_t seed);
  // Makes a candidate of the last score() part of the model. Throws std::invalid_argument.
  [[nodiscard]] std::unique_ptr<EffectInModel> adopted(std::size_t candidate);
  // Named candidates that explain as much as the effect `id`, which is one of them.
  [[nodiscard]] std::vector<std::string> as_good_as(const EffectId& id);

 private:
  [[nodiscard]] bool refines(const EffectId& higher, const EffectId& lower) const;
  [[nodiscard]] std::vector<const ObservationEffect*> open() const;  // named and not adopted
  [[nodiscard]] std::size_t n_latent() const;
  void prepare();
  [[nodiscard]] double left_squares() const;  // held-out squares of the fit's residual
  [[nodiscard]] double constants_gain(const TestedResidual& tested) const;
  // scores: of the named candidates, in their order.
  void refuse_unspecific(std::vector<CandidateScore>& scores, double by_constants) const;
  // What there is to explain, as held-out squares in noise variances.
  struct Unexplained {
    double above_noise = 0.0;
    double by_learned = 0.0;    // gain of the best learned pattern; 0: immaterial
    double by_constants = 0.0;  // of all constants that are still open, together
  };
  [[nodiscard]] std::string smallness(const EffectCandidate& candidate, double gain, double above_noise) const;
  [[nodiscard]] Objection refusal(const EffectCandidate& candidate, double gain, const TestedResidual& tested,
                                  const Unexplained& unexplained) const;

  const ObservationFit& fit_;
  const std::vector<const ObservationEffect*>& catalogue_;
  std::vector<std::unique_ptr<EffectCandidate>> prepared_;  // named ones first, then the latent one, if any
  std::vector<char> is_other_cause_;                        // per candidate of the last score()
  mutable std::optional<double> left_squares_;              // computed on request
  bool is_prepared_ = false, is_scored_ = false;
};

}  // namespace core::closure
