#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/closure/observation/effect_candidate.h"
#include "core/closure/observation/effect_in_model.h"
#include "core/closure/observation/fit_view.h"
#include "core/closure/observation/run_correction.h"
#include "core/types/closure_result.h"

namespace core::closure {

// One physical cause that may be missing in the observation level: one file in effects/ and one line in
// effects/catalogue.h. A subclass of one of the kinds (kinds/): a pattern over the image with an amplitude per frame,
// constants of the record, or a spectral line. Stateless: the candidate holds what is found in a record, the
// EffectInModel what is fitted.
class ObservationEffect {
 public:
  ObservationEffect() = default;
  ObservationEffect(const ObservationEffect&) = delete;
  ObservationEffect& operator=(const ObservationEffect&) = delete;
  virtual ~ObservationEffect() = default;

  [[nodiscard]] virtual EffectId id() const = 0;
  [[nodiscard]] virtual std::string name() const = 0;  // for readers
  [[nodiscard]] virtual std::size_t n_parameters() const = 0;

  // Reason why the effect cannot be observed. Empty: observable in this record, or already adopted.
  [[nodiscard]] virtual std::optional<NotObservable> obstacle(const FitView& fit, bool is_adopted) const = 0;
  // Valid until the next fit. The effect must outlive it.
  [[nodiscard]] virtual std::unique_ptr<EffectCandidate> candidate(const FitView& fit) const = 0;

  // The patterns over the points of which its own is a combination: px per unit, 2 points x patterns; without columns
  // where it has no such pattern. For comparison with patterns that have no name.
  [[nodiscard]] virtual Eigen::MatrixXd shapes(const FitView& fit) const {
    return Eigen::MatrixXd(fit.model.weight().size(), 0);
  }

  // Higher terms of the same cause as `lower`: never a rival of it, because the smallest sufficient model is preferred.
  [[nodiscard]] virtual bool refines(const EffectId& /*lower*/) const { return false; }

  // Whether a run corrects this effect in its own points, once reports agree on it, and how. By default it does not.
  [[nodiscard]] virtual const InFlightCorrection* in_flight() const { return nullptr; }
};

}  // namespace core::closure
