#include "core/closure/observation/effects/catalogue.h"

namespace core::closure {

const EffectList<ObservationEffect>& observation_effects() {
  static const auto kAll = effect_list<ObservationEffect>({HOVERMODAL_OBSERVATION_EFFECTS(HOVERMODAL_MAKER)});
  return kAll;
}

const EffectList<AbsorbedEffect>& absorbed_effects() {
  static const auto kAll = effect_list<AbsorbedEffect>({HOVERMODAL_ABSORBED_EFFECTS(HOVERMODAL_MAKER)});
  return kAll;
}

const ObservationEffect* observation_effect(const EffectId& id) {
  return find_effect(observation_effects(), id.key, [](const ObservationEffect& effect) { return effect.id().key; });
}

std::vector<NotObservable> never_observable() {
  return {
      {"time stamp jitter, dropped and duplicated frames",
       "the displacement of every region is free in each frame and absorbs an error of the frame's time",
       "trust the source's stamps and sequence numbers, or film a clock; a predictor over time of the regions' motion "
       "could show them"},
      {"clock rate", "a wrong rate scales all frequencies alike and leaves no residual",
       "film a clock, or give reference frequencies"},
      {"scale, and its slow change", "zoom of the structure's plane is free in each frame",
       "declare a known length per region"},
      {"constant part of yaw and pitch", "it is a translation of the whole image, which is free in each frame",
       "modes are unaffected: displacement relative to the base remains"},
      {"a stabiliser's zoom and warp", "its zoom is free in each frame; any remaining warp appears as a latent effect",
       "switch the camera's stabilisation off"},
      {"tilt of single floors",
       "the model turns the structure as a whole only; the tilt of one floor appears as a latent effect",
       "declare larger regions, or several on one floor"},
  };
}

}  // namespace core::closure
