#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/types/closure_result.h"

namespace core::closure {

// The model with all adopted effects, fitted together.
struct LevelFit {
  double residual_rms = 0.0;
  double noise_floor = 0.0;
  double heldout = 0.0;     // error on data excluded from the fit; infinite where nothing can be held out
  bool structured = false;  // is the residual more than noise?
  std::string words;        // result of the test for structure, for a reader
};

// One level of residual diagnosis ("closing the loop": model correction, not SLAM's loop closure): a model of a record,
// its candidate effects and their scores. The state is the list of adopted effects. A level owns its record. Candidate
// ids are valid until the next adopt() or drop(); adopted effects are numbered in order of adoption. Only
// surrogate_score() is random; its seed determines the result.
class ClosureLevel {
 public:
  ClosureLevel() = default;
  ClosureLevel(const ClosureLevel&) = delete;
  ClosureLevel& operator=(const ClosureLevel&) = delete;
  virtual ~ClosureLevel() = default;

  [[nodiscard]] virtual std::string name() const = 0;  // "observation" | "response" | "structure"
  [[nodiscard]] virtual std::string unit() const = 0;  // of residuals and held-out errors

  // Effects that are not observable in this record, however large they are.
  [[nodiscard]] virtual std::vector<NotObservable> not_observable() const = 0;

  // Effects that may still be adopted: named ones, and latent ones if the level supports them.
  [[nodiscard]] virtual std::vector<std::string> candidates() const = 0;

  // Fits the model with every adopted effect.
  virtual LevelFit fit() = 0;

  // Fits each candidate on top of the last fit() and scores it on held-out data, in the order of candidates(). The
  // level sets refusals (immaterial, implausible, projection of another effect).
  [[nodiscard]] virtual std::vector<CandidateScore> score() = 0;

  // The largest score of any candidate on one surrogate: a record of this model without a further effect.
  [[nodiscard]] virtual double surrogate_score(std::uint64_t seed) = 0;

  virtual void adopt(std::size_t candidate) = 0;
  virtual void drop() = 0;  // reverts the last adoption
  // Removes an effect that those adopted after it have made needless; its number, or empty: none. After a fit(); the
  // next one is due if a number is returned.
  virtual std::optional<std::size_t> drop_needless() { return std::nullopt; }

  // The same for an effect that is due to one of absorbed().
  virtual std::optional<std::size_t> drop_pretended() { return std::nullopt; }

  // What an adopted effect changes in the data, rms in the level's unit, after the last fit(). 0: only what it takes
  // from the residual is known.
  [[nodiscard]] virtual double size_of(std::size_t /*adopted*/) const { return 0.0; }

  // Parameters of an adopted effect, after the last fit().
  [[nodiscard]] virtual std::vector<ParameterValue> parameters(std::size_t adopted) const = 0;

  // What the parameters imply, e.g. a storey height; for a latent effect, its description. May be empty.
  [[nodiscard]] virtual std::string meaning(std::size_t /*adopted*/) const { return {}; }

  // Candidates that explain the data as well as the adopted effect when they replace it: the held-out scores agree
  // within their uncertainty. `seed`: for levels that estimate that uncertainty from surrogates.
  [[nodiscard]] virtual std::vector<std::string> rivals(std::size_t adopted, std::uint64_t seed) = 0;

  // Effects that the free quantities of the last fit() absorb: they leave no residual and are found in those
  // quantities. Named, with parameters and meaning, score and threshold; without errors.
  [[nodiscard]] virtual std::vector<ClosureStep> absorbed() const { return {}; }

  // Results of the last fit().
  [[nodiscard]] virtual std::vector<ClosureMode> modes() const = 0;
  [[nodiscard]] virtual std::optional<double> reference_error() const = 0;
  [[nodiscard]] virtual std::string reference_unit() const { return unit(); }  // of reference_error()
  [[nodiscard]] virtual std::string describe_residual() const = 0;             // of the last fit: where and how large
  // Noise of the data as the last fit() shows it, and how to lower it. Empty: not measured.
  struct Noise {
    std::vector<ParameterValue> values;
    std::string advice;
  };
  [[nodiscard]] virtual Noise noise() const { return {}; }
};

}  // namespace core::closure
