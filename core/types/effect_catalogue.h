#pragma once

#include <memory>
#include <string_view>
#include <vector>

namespace core {

// The shape of a catalogue of effects, the same at every level of residual diagnosis: an effect is a stateless subclass
// of its level's interface in a file of its own, NAME.cpp, which defines make_NAME(); effects/catalogue.h of the level
// lists the names, one line each, and from that list declares the makers and fills the list.
template <class Effect>
using EffectList = std::vector<std::unique_ptr<Effect>>;

// nullptr: none of that id. id_of: what an effect answers.
template <class Effect, class IdOf>
[[nodiscard]] const Effect* find_effect(const EffectList<Effect>& effects, std::string_view id, const IdOf& id_of) {
  for (const auto& effect : effects) {
    if (id_of(*effect) == id) return effect.get();
  }
  return nullptr;
}

}  // namespace core
