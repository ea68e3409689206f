#include "core/structure/effects/catalogue.h"

namespace core::structure {

const EffectList<StructuralEffect>& structural_effects() {
  static const auto kAll = effect_list<StructuralEffect>({HOVERMODAL_STRUCTURAL_EFFECTS(HOVERMODAL_MAKER)});
  return kAll;
}

}  // namespace core::structure
