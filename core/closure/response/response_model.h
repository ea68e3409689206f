#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/types/closure_result.h"

namespace core::closure {

// Result of fitting a response model with a set of effects to its record.
struct ResponseFit {
  double residual_rms = 0.0;         // in the model's unit
  double heldout_rms = 0.0;          // on data excluded from its fit; infinite if it cannot be fitted
  std::vector<double> fold_squares;  // squared errors summed per left-out part of the record
  double noise_variance = 1.0;       // of one value of those squares
  double noise_floor = 0.0;          // residual expected from noise alone
  bool structured = true;            // is the residual more than noise?
  std::string words;                 // result of that test, for a reader
  std::size_t n_parameters = 0;      // of the effects
  std::vector<std::vector<ParameterValue>> parameters;  // per effect, in the requested order
  std::vector<std::string> implausible;                 // per effect: why its parameters are implausible; or empty
  std::vector<ClosureMode> modes;
  std::string left;  // description of the residual: where and how large

  [[nodiscard]] double heldout_squares() const noexcept {
    double sum = 0.0;
    for (const double fold : fold_squares) sum += fold;
    return sum;
  }
};

// Interface of a response level to one kind of record: its prediction with any set of effects, and surrogate
// records of the same model. Plain data; every function is a pure function of the model and its arguments. One
// thread.
class ResponseModel {
 public:
  ResponseModel() = default;
  ResponseModel(const ResponseModel&) = delete;
  ResponseModel& operator=(const ResponseModel&) = delete;
  virtual ~ResponseModel() = default;

  [[nodiscard]] virtual std::string unit() const = 0;
  // Effects that are observable in this record, in the order of the catalogue.
  [[nodiscard]] virtual std::vector<std::string> effects() const = 0;
  [[nodiscard]] virtual std::vector<NotObservable> not_observable() const = 0;
  // Materiality threshold: share by which the held-out squares must decrease.
  [[nodiscard]] virtual double material_share(const std::string& effect) const = 0;
  // The model with these effects, in the order of adoption. Never throws on data: a model that cannot be fitted has an
  // infinite held-out error.
  [[nodiscard]] virtual ResponseFit fit(const std::vector<std::string>& effects) const = 0;
  // A surrogate: a record of the model with these effects and noise, of the same size.
  [[nodiscard]] virtual std::unique_ptr<ResponseModel> surrogate(const std::vector<std::string>& effects,
                                                                 std::uint64_t seed) const = 0;
};

}  // namespace core::closure
