#include "core/closure/effects/readout.h"

namespace core::closure {

// The model itself holds the readout (FrameModel::solve); the value is added to what was declared.
ObservationEffect readout_effect() {
  ObservationEffect effect;
  effect.name = "readout time";
  effect.form = ObservationEffect::Form::kReadout;
  effect.parameters = {"added readout"};
  effect.unit = "frames";
  effect.plausible = 1.5;
  return effect;
}

}  // namespace core::closure
