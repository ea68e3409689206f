#pragma once

#include <initializer_list>
#include <memory>
#include <string_view>
#include <vector>

namespace core {

// Common form of the catalogues of effects of all levels: an effect is a stateless subclass of its level's interface in
// a file of its own, NAME.cpp, which defines make_NAME(). effects/catalogue.h of the level lists the names, one line
// each; from this list it declares the makers and builds the catalogue.
template <class Effect>
using EffectList = std::vector<std::unique_ptr<Effect>>;

// Of the makers in a level's list: effect_list<Effect>({LIST(HOVERMODAL_MAKER)}).
#define HOVERMODAL_MAKER(name) make_##name,
template <class Effect>
[[nodiscard]] EffectList<Effect> effect_list(std::initializer_list<std::unique_ptr<Effect> (*)()> makers) {
  EffectList<Effect> all;
  for (const auto make : makers) all.push_back(make());
  return all;
}

// nullptr: no effect has that id. id_of: function that returns the id of an effect.
template <class Effect, class IdOf>
[[nodiscard]] const Effect* find_effect(const EffectList<Effect>& effects, std::string_view id, const IdOf& id_of) {
  for (const auto& effect : effects) {
    if (id_of(*effect) == id) return effect.get();
  }
  return nullptr;
}

}  // namespace core
