#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/closure/observation/fit_view.h"
#include "core/closure/observation/free_motions.h"
#include "core/types/closure_result.h"

namespace core::closure {

// What such an effect does in a record.
struct AbsorbedFinding {
  std::vector<ParameterValue> parameters;
  std::string meaning;
  double score = 0.0, threshold = 0.0;  // chi-square / 2, of the motion beyond its known causes
  std::optional<double> hz = {};        // of a resonance
  // What the model takes wrongly because of it, without the model's columns: 2 points x frames in sigmas at the frames'
  // common instants. Empty: nothing.
  Eigen::MatrixXd left = {};
};

// An effect that the model's free motions absorb: it leaves no residual, and adopting it cannot lower the held-out
// error. It is found in those motions (free_motions.h), by what one of them does beyond its known causes, in the final
// model. One file in effects/ and one line in effects/catalogue.h. Stateless.
class AbsorbedEffect {
 public:
  AbsorbedEffect() = default;
  AbsorbedEffect(const AbsorbedEffect&) = delete;
  AbsorbedEffect& operator=(const AbsorbedEffect&) = delete;
  virtual ~AbsorbedEffect() = default;

  [[nodiscard]] virtual EffectId id() const = 0;
  [[nodiscard]] virtual std::string name() const = 0;  // for readers
  // What a record without a background leaves open.
  [[nodiscard]] virtual NotObservable without_background() const = 0;
  // Empty: the record does not show it.
  [[nodiscard]] virtual std::optional<AbsorbedFinding> find(const FitView& fit, const FreeMotions& motions) const = 0;
};

}  // namespace core::closure
