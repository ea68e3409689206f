#include "core/closure/response/effects/catalogue.h"

#include <stdexcept>

namespace core::closure {
namespace {

template <class Effect>
const Effect& by_name(const EffectList<Effect>& all, const std::string& name) {
  const Effect* found = find_effect(all, name, [](const Effect& effect) { return effect.name(); });
  if (found == nullptr) throw std::invalid_argument("response: no effect is called " + name);
  return *found;
}

}  // namespace

const EffectList<ClockEffect>& clock_effects() {
  static const auto kAll = effect_list<ClockEffect>({HOVERMODAL_CLOCK_EFFECTS(HOVERMODAL_MAKER)});
  return kAll;
}

const EffectList<DecayEffect>& decay_effects() {
  static const auto kAll = effect_list<DecayEffect>({HOVERMODAL_DECAY_EFFECTS(HOVERMODAL_MAKER)});
  return kAll;
}

const EffectList<ChannelEffect>& channel_effects() {
  static const auto kAll = effect_list<ChannelEffect>({HOVERMODAL_CHANNEL_EFFECTS(HOVERMODAL_MAKER)});
  return kAll;
}

const ClockEffect& clock_effect(const std::string& name) { return by_name(clock_effects(), name); }
const DecayEffect& decay_effect(const std::string& name) { return by_name(decay_effects(), name); }
const ChannelEffect& channel_effect(const std::string& name) { return by_name(channel_effects(), name); }

}  // namespace core::closure
