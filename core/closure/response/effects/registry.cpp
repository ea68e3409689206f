#include <stdexcept>

#include "core/closure/response/effects/channel_effect.h"
#include "core/closure/response/effects/clock_effect.h"
#include "core/closure/response/effects/decay_effect.h"

namespace core::closure {
namespace {

template <class Effect>
const Effect& by_name(const std::vector<std::unique_ptr<Effect>>& all, const std::string& name) {
  for (const auto& effect : all) {
    if (effect->name() == name) return *effect;
  }
  throw std::invalid_argument("response: no effect is called " + name);
}

}  // namespace

const std::vector<std::unique_ptr<ClockEffect>>& clock_effects() {
  static const std::vector<std::unique_ptr<ClockEffect>> kAll = [] {
    std::vector<std::unique_ptr<ClockEffect>> all;
    all.push_back(make_clock_rate());
    all.push_back(make_clock_rate_drift());
    all.push_back(make_clock_lost_frames());
    return all;
  }();
  return kAll;
}

const std::vector<std::unique_ptr<DecayEffect>>& decay_effects() {
  static const std::vector<std::unique_ptr<DecayEffect>> kAll = [] {
    std::vector<std::unique_ptr<DecayEffect>> all;
    all.push_back(make_amplitude_frequency());
    all.push_back(make_amplitude_damping());
    all.push_back(make_further_mode());
    all.push_back(make_rest_drift());
    return all;
  }();
  return kAll;
}

const std::vector<std::unique_ptr<ChannelEffect>>& channel_effects() {
  static const std::vector<std::unique_ptr<ChannelEffect>> kAll = [] {
    std::vector<std::unique_ptr<ChannelEffect>> all;
    all.push_back(make_duplicated_frames());
    all.push_back(make_dropped_frames());
    all.push_back(make_time_stamp_jitter());
    all.push_back(make_frequency_drift());
    all.push_back(make_softening());
    all.push_back(make_input_colour());
    return all;
  }();
  return kAll;
}

const ChannelEffect& channel_effect(const std::string& name) { return by_name(channel_effects(), name); }

const DecayEffect& decay_effect(const std::string& name) { return by_name(decay_effects(), name); }

const ClockEffect& clock_effect(const std::string& name) { return by_name(clock_effects(), name); }

}  // namespace core::closure
