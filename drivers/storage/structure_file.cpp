#include "drivers/storage/structure_file.h"

#include <fmt/format.h>

#include <functional>
#include <stdexcept>

#include "drivers/storage/limits.h"
#include "drivers/storage/structure_kinds.h"
#include "drivers/storage/structure_value.h"
#include "drivers/storage/yaml.h"

namespace drivers {
namespace {

using core::structure::DeclaredFrame;

struct Key {
  const char *name, *meaning;
  std::function<void(const StructureMap&, const char* key, DeclaredFrame&)> set;
};

const std::vector<Key>& keys() {
  static const std::vector<Key> kKeys{
      {"kind", "shear_frame: rigid floors on columns that shear; or another kind, see below",
       [](const StructureMap&, const char*, DeclaredFrame&) {}},
      {"storeys", "how many floors move",
       [](const StructureMap& m, const char* key, DeclaredFrame& f) {
         f.n_storeys = m.whole_or(key, 1, core::structure::kMaxStoreys, 0);
       }},
      {"storey_height_mm", "height of each storey; tests gravity softening",
       [](const StructureMap& m, const char* key, DeclaredFrame& f) { f.storey_height_mm = m.number(key, 1.0, 1e5); }},
      {"masses", "of the floors, relative to each other, lowest first (default: equal)",
       [](const StructureMap& m, const char* key, DeclaredFrame& f) { f.mass = m.numbers(key, 1e-6, 1e6, 0); }},
      {"stiffness_ratio", "of the storeys, relative to each other, lowest first (default: equal)",
       [](const StructureMap& m, const char* key, DeclaredFrame& f) {
         f.stiffness_ratio = m.numbers(key, 1e-6, 1e6, 0);
       }},
      {"stiffness_over_mass_per_s2", "of ratio 1 over mass 1, where known (default: fitted)",
       [](const StructureMap& m, const char* key, DeclaredFrame& f) {
         f.stiffness_over_mass_per_s2 = m.number(key, 1e-6, 1e12);
       }},
      {"temperature", "{stiffness_per_k}: relative change of stiffness per kelvin; tests another temperature",
       [](const StructureMap& m, const char*, DeclaredFrame& f) { f.temperature = parse_temperature(m); }},
      {"data", "measured | simulated: where the reference comes from (default: measured)",
       [](const StructureMap& m, const char* key, DeclaredFrame& f) {
         f.simulated = m.one_of(key, {"measured", "simulated"}) == "simulated";
       }},
      {"dt_s", "time step of that simulation, where known",
       [](const StructureMap& m, const char* key, DeclaredFrame& f) { f.dt_s = m.number(key, 1e-9, 1e3); }},
      {"frequency_sigma_percent",
       "of reference frequencies that state none (default: 0.15;\n                              of a modal.json 1.2 "
       "sqrt(zeta / (2 pi f T)), if larger)",
       [](const StructureMap& m, const char* key, DeclaredFrame& f) {
         f.frequency_sigma = 0.01 * m.number(key, 1e-4, 20.0);
       }},
      {"shape_sigma", "of shape components that state none, largest component 1 (default: 0.02)",
       [](const StructureMap& m, const char* key, DeclaredFrame& f) { f.shape_sigma = m.number(key, 1e-4, 1.0); }},
      {"floors", "the reference's channels, lowest first: shapes are then compared as well",
       [](const StructureMap& m, const char* key, DeclaredFrame& f) { f.floors = m.texts(key); }}};
  return kKeys;
}

const YamlNode& section(const YamlNode& root, const std::string& file) {
  const YamlNode* found = root.kind == YamlNode::Kind::kMap ? root.find("structure") : nullptr;
  if (found == nullptr || found->kind != YamlNode::Kind::kMap) {
    throw FileError(fmt::format("{}:{}: no section `structure`; write structure: {{kind: shear_frame, storeys: 6}}",
                                file, root.line));
  }
  for (std::size_t i = 0; i < root.keys.size(); ++i) {
    if (root.keys[i] != "structure") {
      throw FileError(fmt::format("{}:{}: `{}` is not known here; only `structure` is", file, root.key_lines[i],
                                  printable(root.keys[i])));
    }
  }
  return *found;
}

// A kind of its own, or a shear frame whose storeys are searched for a place.
bool is_other_kind(const YamlNode& structure) {
  const YamlNode* kind = structure.find("kind");
  const YamlNode* locate = structure.find("locate");
  return (kind != nullptr && kind->text != "shear_frame") || (locate != nullptr && locate->text == "true");
}

}  // namespace

DeclaredFrame parse_structure(const std::string& text, const std::string& name) {
  const YamlNode root = parse_yaml(text, name);
  const YamlNode& structure = section(root, name);
  if (is_other_kind(structure)) return parse_structure_kind(structure, name);
  const StructureMap map(structure, "structure", name);
  std::vector<const char*> names;
  for (const Key& key : keys()) names.push_back(key.name);
  map.allow(names);
  DeclaredFrame frame;
  for (const Key& key : keys()) {
    if (map.has(key.name)) key.set(map, key.name, frame);
  }
  if (structure.find("storeys") == nullptr)
    throw FileError(fmt::format("{}:{}: structure.storeys is missing; say how many floors move", name, structure.line));
  if (frame.dt_s && !frame.simulated) {
    throw FileError(fmt::format("{}:{}: structure.dt_s belongs to `data: simulated`; add it, or leave dt_s out", name,
                                structure.line));
  }
  try {
    core::structure::validate(frame);
  } catch (const std::invalid_argument& error) {
    throw FileError(fmt::format("{}:{}: structure.{}", name, structure.line, error.what()));
  }
  return frame;
}

DeclaredFrame read_structure(const std::string& path) {
  return parse_structure(read_text_file(path, Limits::kYamlBytes), path);
}

std::string structure_keys_help() {
  std::string out;
  for (const Key& key : keys()) out += fmt::format("  {:<28}{}\n", key.name, key.meaning);
  return out + structure_kinds_help();
}

}  // namespace drivers
