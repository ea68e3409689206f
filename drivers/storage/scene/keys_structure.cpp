#include <utility>

#include "drivers/storage/scene/key.h"

namespace drivers {
namespace {

using Axis = core::simulation::StructureModel::Axis;
using S = SceneStructure;
using Type = S::Type;

template <auto member>
auto& structure(SceneFile& file, std::size_t) {
  return file.structure.*member;
}

SceneKey only_for(SceneKey key, std::vector<Type> types) {
  key.applies = [types = std::move(types)](const SceneFile& file) {
    for (const Type type : types) {
      if (file.structure.type == type) return true;
    }
    return false;
  };
  return key;
}

// A member of a description within the structure: frame.mass_kg.
template <auto part, auto member>
auto& in(SceneFile& file, std::size_t) {
  return file.structure.*part.*member;
}

void add_frame_keys(std::vector<SceneKey>& keys) {
  using Frame = core::simulation::ShearBuilding;
  keys.push_back(only_for(scene_numbers("structure.mass_kg", "kg", in<&S::frame, &Frame::mass_kg>, {1e-9, 1e12},
                                        "of each floor (modes: of each body; [] = equal), from the lowest"),
                          {Type::kShearFrame, Type::kModes}));
  keys.push_back(only_for(scene_numbers("structure.stiffness_n_per_m", "N/m", in<&S::frame, &Frame::stiffness_n_per_m>,
                                        {-1e15, 1e15}, "of the columns below each floor"),
                          {Type::kShearFrame}));
  keys.push_back(
      only_for(scene_number("structure.ground_spring_n_per_m", "N/m", in<&S::frame, &Frame::ground_spring_n_per_m>,
                            {0.0, 1e15}, "under the lowest columns, in series with them; 0 = rigid"),
               {Type::kShearFrame}));
  keys.push_back(only_for(scene_numbers("structure.storey_height_mm", "mm", in<&S::frame, &Frame::storey_height_mm>,
                                        {1.0, 1e6}, "of each storey: gravity then softens it; [] = no such effect"),
                          {Type::kShearFrame}));
}

void add_beam_keys(std::vector<SceneKey>& keys) {
  using Tower = core::simulation::Cantilever;
  using Deck = core::simulation::BridgeDeck;
  const std::vector<Type> tower{Type::kCantilever}, deck{Type::kBridgeDeck}, both{Type::kCantilever, Type::kBridgeDeck};
  keys.push_back(only_for(
      scene_number("structure.height_mm", "mm", in<&S::tower, &Tower::height_mm>, {1.0, 1e7}, "of the tower"), tower));
  keys.push_back(only_for(
      scene_number("structure.span_mm", "mm", in<&S::deck, &Deck::span_mm>, {1.0, 1e7}, "from support to support"),
      deck));
  keys.push_back(only_for(scene_whole("structure.n_spans", "", in<&S::deck, &Deck::n_spans>, {1, 10},
                                      "equal ones; the deck runs through over the piers"),
                          deck));
  keys.push_back(only_for(scene_choice<Deck::Ends>("structure.ends", in<&S::deck, &Deck::ends>,
                                                   {{"simple", Deck::Ends::kSimple}, {"clamped", Deck::Ends::kClamped}},
                                                   "how the deck is held at its ends"),
                          deck));
  keys.push_back(only_for(scene_whole("structure.bodies", "", in<&S::deck, &Deck::bodies>, {1, 60},
                                      "that are seen, evenly spaced (deck: in each span)"),
                          both));
  keys.push_back(only_for(scene_number("structure.bending_stiffness_n_m2", "N m2",
                                       in<&S::tower, &Tower::bending_stiffness_n_m2>, {1e-9, 1e18}, "EI"),
                          both));
  keys.push_back(only_for(
      scene_number("structure.mass_kg_per_m", "kg/m", in<&S::tower, &Tower::mass_kg_per_m>, {1e-9, 1e9}, "of the beam"),
      both));
  keys.push_back(only_for(
      scene_number("structure.tip_mass_kg", "kg", in<&S::tower, &Tower::tip_mass_kg>, {0.0, 1e9}, "at the top"),
      tower));
}

void add_matrix_keys(std::vector<SceneKey>& keys) {
  const auto add_rows = [&keys](const char* name, S::Rows S::*member, const char* unit, const char* meaning) {
    const SceneField<S::Rows> field = [member](SceneFile& file, std::size_t) -> S::Rows& {
      return file.structure.*member;
    };
    keys.push_back(only_for(scene_rows(name, unit, field, meaning), {Type::kMatrices}));
  };
  add_rows("structure.mass_matrix", &S::mass, "kg", "coordinates x coordinates, symmetric");
  add_rows("structure.damping_matrix", &S::damping, "N s/m", "coordinates x coordinates, symmetric");
  add_rows("structure.stiffness_matrix", &S::stiffness, "N/m", "coordinates x coordinates, symmetric");
  keys.push_back(
      only_for(scene_numbers("structure.influence", "kg", structure<&S::influence>, {-1e15, 1e15},
                             "mass matrix times the rigid motion of the ground; [] = every coordinate is a body"),
               {Type::kMatrices}));
  add_rows("structure.displacement", &S::displacement, "mm",
           "bodies x coordinates: how far each body moves; [] likewise");
  add_rows("structure.tilt", &S::tilt, "rad", "bodies x coordinates: how far each body turns; [] = not");
}

// Matrices include their damping; a chain and given modes have modal damping only.
void add_damping_keys(std::vector<SceneKey>& keys) {
  using Kind = S::DampingKind;
  const auto built = [](const SceneFile& file) { return file.structure.type != Type::kMatrices; };
  const auto physical = [](const SceneFile& file) {
    const Type type = file.structure.type;
    return type == Type::kShearFrame || type == Type::kCantilever || type == Type::kBridgeDeck;
  };
  SceneKey kind = scene_choice<Kind>(
      "structure.damping.kind", structure<&S::damping_kind>,
      {{"modal", Kind::kModal}, {"rayleigh", Kind::kRayleigh}, {"dashpots", Kind::kDashpots}},
      "modal: a ratio for each mode; rayleigh: alpha M + beta K; dashpots: between neighbours, shapes become complex");
  kind.applies = physical;
  keys.push_back(kind);
  const auto add = [&](SceneKey key, Kind of, const std::function<bool(const SceneFile&)>& where) {
    key.applies = [of, where](const SceneFile& file) { return where(file) && file.structure.damping_kind == of; };
    keys.push_back(std::move(key));
  };
  add(scene_numbers("structure.damping.ratio", "", in<&S::modal_damping, &core::simulation::ModalDamping::ratio>,
                    {-0.5, 0.9}, "by mode; the last holds for all above; 0.01 = 1 %"),
      Kind::kModal, built);
  add(scene_number("structure.damping.alpha_1_s", "1/s",
                   in<&S::rayleigh, &core::simulation::RayleighDamping::alpha_1_s>, {-1e6, 1e6}, "of the mass"),
      Kind::kRayleigh, physical);
  add(scene_number("structure.damping.beta_s", "s", in<&S::rayleigh, &core::simulation::RayleighDamping::beta_s>,
                   {-1e6, 1e6}, "of the stiffness"),
      Kind::kRayleigh, physical);
  add(scene_numbers("structure.damping.n_s_per_m", "N s/m", in<&S::dashpots, &core::simulation::Dashpots::n_s_per_m>,
                    {-1e12, 1e12}, "between each body and the one before it, the first to the ground; 0 = none there"),
      Kind::kDashpots, physical);
}

}  // namespace

void add_structure_keys(std::vector<SceneKey>& keys) {
  keys.push_back(
      scene_choice<Type>("structure.type", structure<&S::type>,
                         {{"uniform_chain", Type::kUniformChain},
                          {"shear_frame", Type::kShearFrame},
                          {"cantilever", Type::kCantilever},
                          {"bridge_deck", Type::kBridgeDeck},
                          {"modes", Type::kModes},
                          {"matrices", Type::kMatrices}},
                         "uniform_chain: a shear building of given frequencies; modes: shapes too; matrices: M C K"));
  keys.push_back(only_for(scene_choice<Axis>("structure.axis", structure<&S::axis>, {{"x", Axis::kX}, {"y", Axis::kY}},
                                             "of the motion: x to the right, y downwards"),
                          {Type::kModes, Type::kMatrices}));
  keys.push_back(only_for(scene_numbers("structure.frequency_hz", "Hz", structure<&S::frequency_hz>, {1e-3, 1e3},
                                        "natural frequencies, one for each mode"),
                          {Type::kUniformChain, Type::kModes}));
  add_frame_keys(keys);
  add_beam_keys(keys);
  keys.push_back(only_for(scene_rows("structure.shapes", "", structure<&S::shapes>,
                                     "one row for each mode: displacement of every body, at any scale"),
                          {Type::kModes}));
  keys.push_back(only_for(scene_rows("structure.tilts", "rad per mm", structure<&S::tilts>,
                                     "one row for each mode: turn of every body, at the shape's scale; [] = none"),
                          {Type::kModes}));
  add_matrix_keys(keys);
  add_damping_keys(keys);
}

}  // namespace drivers
