#pragma once

#include <string>
#include <vector>

#include "core/types/closure_result.h"

namespace core::closure {

// Rates of one mode at a given amplitude.
struct DecayRates {
  double log_rate = 0.0;      // ln of the decay rate, 1/s
  double frequency_hz = 0.0;  // damped
};

// Departure of a free decay from one linear mode.
class DecayEffect {
 public:
  DecayEffect() = default;
  DecayEffect(const DecayEffect&) = delete;
  DecayEffect& operator=(const DecayEffect&) = delete;
  virtual ~DecayEffect() = default;

  [[nodiscard]] virtual std::string name() const = 0;
  // For effects that change the mode's rates with x = ln(amplitude / reference amplitude).
  [[nodiscard]] virtual std::size_t n_parameters() const { return 0; }
  [[nodiscard]] virtual double start() const { return 0.0; }  // of the first parameter; tested with both signs
  virtual void apply(const double* /*parameters*/, double /*x*/, DecayRates& /*rates*/) const {}
  [[nodiscard]] virtual std::vector<ParameterValue> describe(const double* /*parameters*/) const { return {}; }
  // For effects that change the form of the model.
  [[nodiscard]] virtual bool adds_mode() const { return false; }
  [[nodiscard]] virtual bool rest_drifts() const { return false; }
};

}  // namespace core::closure
