#include "core/closure/effects/rotor_line.h"

namespace core::closure {

// The search is that of core/closure/observation/line_search.h.
ObservationEffect rotor_line_effect() {
  ObservationEffect effect;
  effect.name = "rotor line";
  effect.form = ObservationEffect::Form::kLine;
  effect.parameters = {"frequency"};
  effect.unit = "Hz";
  return effect;
}

}  // namespace core::closure
