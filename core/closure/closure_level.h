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
  double heldout = 0.0;     // error on data that the fit did not see; infinite where nothing can be left out
  bool structured = false;  // is the residual more than noise?
  std::string words;        // what the test of structure found
};

// One level of closing the loop: a model of a record, what may be missing in it, and how a candidate is judged. Adopted
// effects are its state. A level holds its own record; ids of candidates stay valid until the next adopt() or drop(),
// those of adopted effects are places in the order of adoption. Nothing here draws at random but surrogate_score(),
// whose draws depend on the seed alone. One thread.
class ClosureLevel {
 public:
  ClosureLevel() = default;
  ClosureLevel(const ClosureLevel&) = delete;
  ClosureLevel& operator=(const ClosureLevel&) = delete;
  virtual ~ClosureLevel() = default;

  [[nodiscard]] virtual std::string name() const = 0;  // "observation" | "response" | "structure"
  [[nodiscard]] virtual std::string unit() const = 0;  // of residuals and held-out errors

  // Effects that this record cannot show, whatever their size.
  [[nodiscard]] virtual std::vector<NotObservable> not_observable() const = 0;

  // Effects that may still be adopted: named ones, and latent ones as far as the level knows any.
  [[nodiscard]] virtual std::vector<std::string> candidates() const = 0;

  // Fits the model with every adopted effect.
  virtual LevelFit fit() = 0;

  // Each candidate fitted on top of the last fit() and scored on held-out data, in the order of candidates(). Refusals
  // (immaterial, implausible, a mere projection of another) are the level's.
  [[nodiscard]] virtual std::vector<CandidateScore> score() = 0;

  // The largest score that any candidate reaches on a record of this model without a further effect.
  [[nodiscard]] virtual double surrogate_score(std::uint64_t seed) = 0;

  virtual void adopt(std::size_t candidate) = 0;
  virtual void drop() = 0;  // takes the last adoption back

  // Of an adopted effect, after the last fit().
  [[nodiscard]] virtual std::vector<ParameterValue> parameters(std::size_t adopted) const = 0;

  // Its numbers in other words; a latent effect described. May be empty.
  [[nodiscard]] virtual std::string meaning(std::size_t /*adopted*/) const { return {}; }

  // Candidates that would do as well in the place of an adopted effect: their held-out score lies within the scatter of
  // its own. `seed` for a level that finds the scatter by surrogates.
  [[nodiscard]] virtual std::vector<std::string> rivals(std::size_t adopted, std::uint64_t seed) = 0;

  // Of the last fit().
  [[nodiscard]] virtual std::vector<ClosureMode> modes() const = 0;
  [[nodiscard]] virtual std::optional<double> reference_error() const = 0;
  [[nodiscard]] virtual std::string reference_unit() const { return unit(); }  // of reference_error()
  [[nodiscard]] virtual std::string describe_residual() const = 0;             // of what is left: where, how much
};

}  // namespace core::closure
