#include "core/simulation/presets.h"

#include <algorithm>

#include "drivers/storage/scene/key.h"

namespace drivers {
namespace {

using core::simulation::BridgeDeck;
using core::simulation::Cantilever;
using core::simulation::ShearBuilding;
using core::simulation::UniformChain;
using Type = SceneStructure::Type;

struct Describe {
  SceneStructure& out;
  void operator()(const UniformChain& chain) const {
    out.type = Type::kUniformChain;
    out.frequency_hz = chain.frequency_hz;
  }
  void operator()(const ShearBuilding& frame) const {
    out.type = Type::kShearFrame;
    out.frame = frame;
  }
  void operator()(const Cantilever& tower) const {
    out.type = Type::kCantilever;
    out.tower = tower;
    out.deck.bodies = tower.bodies;
  }
  void operator()(const BridgeDeck& deck) const {
    out.type = Type::kBridgeDeck;
    out.deck = deck;
    out.tower.bending_stiffness_n_m2 = deck.bending_stiffness_n_m2;
    out.tower.mass_kg_per_m = deck.mass_kg_per_m;
  }
};

}  // namespace

std::vector<std::string> scene_presets() {
  std::vector<std::string> names;
  for (const auto& preset : core::simulation::presets()) names.push_back(preset.name);
  return names;
}

void start_from_preset(SceneFile& file, const std::string& name) {
  file.preset = name;
  file.scene = core::simulation::make_preset(name, file.scene.seed, file.scene.duration_s);
  const auto& all = core::simulation::presets();
  const auto preset = std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.name == name; });
  const core::simulation::StructureDescription description = preset->structure();
  file.structure = {};
  file.structure.axis = file.scene.structure.axis;
  file.structure.modal_damping = description.damping;
  std::visit(Describe{file.structure}, description.kind);
}

}  // namespace drivers
