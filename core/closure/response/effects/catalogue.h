#pragma once

#include <memory>
#include <string>

#include "core/closure/response/effects/channel_effect.h"
#include "core/closure/response/effects/clock_effect.h"
#include "core/closure/response/effects/decay_effect.h"
#include "core/types/effect_catalogue.h"

// The effects of the response level by kind of record, one line each, in the order in which they are tested. The file
// effects/NAME.cpp defines make_NAME().
#define HOVERMODAL_CLOCK_EFFECTS(EFFECT) \
  EFFECT(clock_rate)                     \
  EFFECT(clock_rate_drift)               \
  EFFECT(clock_lost_frames)

#define HOVERMODAL_DECAY_EFFECTS(EFFECT) \
  EFFECT(amplitude_frequency)            \
  EFFECT(amplitude_damping)              \
  EFFECT(further_mode)                   \
  EFFECT(rest_drift)

#define HOVERMODAL_CHANNEL_EFFECTS(EFFECT) \
  EFFECT(duplicated_frames)                \
  EFFECT(dropped_frames)                   \
  EFFECT(time_stamp_jitter)                \
  EFFECT(frequency_drift)                  \
  EFFECT(softening)                        \
  EFFECT(input_colour)

namespace core::closure {

#define HOVERMODAL_DECLARE(name) [[nodiscard]] std::unique_ptr<ClockEffect> make_##name();
HOVERMODAL_CLOCK_EFFECTS(HOVERMODAL_DECLARE)
#undef HOVERMODAL_DECLARE

#define HOVERMODAL_DECLARE(name) [[nodiscard]] std::unique_ptr<DecayEffect> make_##name();
HOVERMODAL_DECAY_EFFECTS(HOVERMODAL_DECLARE)
#undef HOVERMODAL_DECLARE

#define HOVERMODAL_DECLARE(name) [[nodiscard]] std::unique_ptr<ChannelEffect> make_##name();
HOVERMODAL_CHANNEL_EFFECTS(HOVERMODAL_DECLARE)
#undef HOVERMODAL_DECLARE

[[nodiscard]] const EffectList<ClockEffect>& clock_effects();
[[nodiscard]] const EffectList<DecayEffect>& decay_effects();
[[nodiscard]] const EffectList<ChannelEffect>& channel_effects();
// By name. Throw std::invalid_argument.
[[nodiscard]] const ClockEffect& clock_effect(const std::string& name);
[[nodiscard]] const DecayEffect& decay_effect(const std::string& name);
[[nodiscard]] const ChannelEffect& channel_effect(const std::string& name);

}  // namespace core::closure
