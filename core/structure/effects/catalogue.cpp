#include "core/structure/effects/catalogue.h"

namespace core::structure {

const EffectList<StructuralEffect>& structural_effects() {
  static const EffectList<StructuralEffect> kAll = [] {
    EffectList<StructuralEffect> all;
#define HOVERMODAL_MAKE(name) all.push_back(make_##name());
    HOVERMODAL_STRUCTURAL_EFFECTS(HOVERMODAL_MAKE)
#undef HOVERMODAL_MAKE
    return all;
  }();
  return kAll;
}

}  // namespace core::structure
