#pragma once

#include <memory>
#include <vector>

#include "core/closure/observation/effect.h"
#include "core/closure/observation/kinds/absorbed_effect.h"
#include "core/types/effect_catalogue.h"

// The named effects of the observation level, one line each, in the order in which they are tested. The file
// effects/NAME.cpp defines make_NAME().
#define HOVERMODAL_OBSERVATION_EFFECTS(EFFECT) \
  EFFECT(camera_roll)                          \
  EFFECT(camera_pitch)                         \
  EFFECT(camera_yaw)                           \
  EFFECT(readout_time)                         \
  EFFECT(radial_distortion)                    \
  EFFECT(tangential_distortion)                \
  EFFECT(lens_distortion)                      \
  EFFECT(oblique_view)                         \
  EFFECT(pixel_locking)                        \
  EFFECT(template_zoom)                        \
  EFFECT(flicker)                              \
  EFFECT(rocking)                              \
  EFFECT(torsion)                              \
  EFFECT(moving_part)                          \
  EFFECT(refraction)                           \
  EFFECT(rotor_line)                           \
  EFFECT(camera_vibration)

// Those that the model's free motions absorb.
#define HOVERMODAL_ABSORBED_EFFECTS(EFFECT) \
  EFFECT(focus_breathing)                   \
  EFFECT(stabiliser)                        \
  EFFECT(moving_background)

namespace core::closure {

#define HOVERMODAL_DECLARE(name) [[nodiscard]] std::unique_ptr<ObservationEffect> make_##name();
HOVERMODAL_OBSERVATION_EFFECTS(HOVERMODAL_DECLARE)
#undef HOVERMODAL_DECLARE
#define HOVERMODAL_DECLARE(name) [[nodiscard]] std::unique_ptr<AbsorbedEffect> make_##name();
HOVERMODAL_ABSORBED_EFFECTS(HOVERMODAL_DECLARE)
#undef HOVERMODAL_DECLARE

[[nodiscard]] const EffectList<AbsorbedEffect>& absorbed_effects();
[[nodiscard]] const EffectList<ObservationEffect>& observation_effects();
// nullptr: the catalogue has no such effect.
[[nodiscard]] const ObservationEffect* observation_effect(const EffectId& id);

// Effects that no record of tracks can show at this level, however large they are.
[[nodiscard]] std::vector<NotObservable> never_observable();

}  // namespace core::closure
