#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/closure/observation/compact_field.h"
#include "core/closure/observation/effect_in_model.h"
#include "core/closure/observation/held_out.h"

namespace core::closure {

// A residual under test: 2 points x frames, in sigmas, after the fit of the model.
struct TestedResidual {
  const Eigen::MatrixXd& values;
  const ResidualMoments& moments;
};

// Reason why an effect is refused although it explains the residual.
struct Objection {
  std::string words;            // empty: none
  bool is_other_cause = false;  // it repeats a motion of the model, so it is not even a rival
};

// An effect under test on top of one fit.
class EffectCandidate {
 public:
  EffectCandidate() = default;
  EffectCandidate(const EffectCandidate&) = delete;
  EffectCandidate& operator=(const EffectCandidate&) = delete;
  virtual ~EffectCandidate() = default;

  // Decrease of the held-out squares in noise variances, for any residual.
  [[nodiscard]] virtual double gain(const TestedResidual& residual) const = 0;

  // The same for the residual of the fit itself; the functions below refer to this result.
  virtual double find(const TestedResidual& residual) = 0;
  [[nodiscard]] virtual double material_share() const = 0;         // smallest gain per residual value
  [[nodiscard]] virtual bool is_learned() const { return false; }  // its pattern is taken from the residual
  // It can take the form of many other effects: refused where one of them, or all constants together, gain half of it.
  [[nodiscard]] virtual bool is_unspecific() const { return false; }
  [[nodiscard]] virtual Objection objection(const TestedResidual& /*residual*/) const { return {}; }
  // Gain of the best pattern of any kind in the same place and band, learned from the residual; empty: not comparable.
  [[nodiscard]] virtual std::optional<double> free_gain(const TestedResidual& /*residual*/) const {
    return std::nullopt;
  }
  // Derivatives by its constants of the errors of points left out, 2 points x frames in sigmas; empty: it has none.
  [[nodiscard]] virtual std::span<const CompactField* const> constant_fields() const { return {}; }
  [[nodiscard]] virtual std::unique_ptr<EffectInModel> adopted() const = 0;
};

}  // namespace core::closure
