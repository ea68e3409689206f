#include "drivers/storage/structure_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "drivers/storage/key_suggestion.h"
#include "drivers/storage/limits.h"
#include "drivers/storage/structure_kinds.h"
#include "drivers/storage/yaml.h"

namespace drivers {
namespace {

using core::structure::DeclaredFrame;

class Value {
 public:
  Value(const YamlNode& node, std::string key, const std::string& file)
      : node_(node), key_(std::move(key)), file_(file) {}

  [[noreturn]] void refuse(const std::string& what) const {
    throw FileError(fmt::format("{}:{}: {}: {}", file_, node_.line, key_, what));
  }
  [[nodiscard]] std::string text() const {
    if (node_.kind != YamlNode::Kind::kScalar) refuse("expected one value");
    return node_.text;
  }
  [[nodiscard]] double number(double low, double high) const { return in_range(node_, low, high); }
  [[nodiscard]] std::size_t whole(double low, double high) const {
    const double value = number(low, high);
    if (value != std::floor(value)) refuse(fmt::format("{} is no whole number", printable(node_.text)));
    return static_cast<std::size_t>(value);
  }
  [[nodiscard]] std::vector<double> numbers() const {
    std::vector<double> out;
    for (const YamlNode& item : list()) out.push_back(in_range(item, 1e-6, 1e6));
    return out;
  }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const YamlNode& item : list()) {
      if (item.kind != YamlNode::Kind::kScalar || item.text.empty()) refuse("expected a list of names");
      out.push_back(item.text);
    }
    return out;
  }

 private:
  [[nodiscard]] const std::vector<YamlNode>& list() const {
    if (node_.kind != YamlNode::Kind::kList) refuse("expected a list, lowest storey first: [.., ..]");
    return node_.items;
  }
  [[nodiscard]] double in_range(const YamlNode& node, double low, double high) const {
    const auto value = node.kind == YamlNode::Kind::kScalar ? parse_number(node.text) : std::nullopt;
    if (!value) refuse(fmt::format("`{}` is no number; write a decimal number", printable(node.text)));
    if (!(*value >= low && *value <= high))
      refuse(fmt::format("{} is refused: allowed {:g} .. {:g}", printable(node.text), low, high));
    return *value;
  }

  const YamlNode& node_;
  std::string key_;
  const std::string& file_;
};

struct Key {
  const char *name, *meaning;
  std::function<void(const Value&, DeclaredFrame&)> set;
};

const std::vector<Key>& keys() {
  static const std::vector<Key> kKeys{
      {"kind", "shear_frame: rigid floors on columns that shear; or another kind, see below",
       [](const Value&, DeclaredFrame&) {}},
      {"storeys", "how many floors move",
       [](const Value& v, DeclaredFrame& f) { f.n_storeys = v.whole(1, core::structure::kMaxStoreys); }},
      {"storey_height_mm", "height of each storey; tests gravity softening",
       [](const Value& v, DeclaredFrame& f) { f.storey_height_mm = v.number(1.0, 1e5); }},
      {"masses", "of the floors, relative to each other, lowest first (default: equal)",
       [](const Value& v, DeclaredFrame& f) { f.mass = v.numbers(); }},
      {"stiffness_ratio", "of the storeys, relative to each other, lowest first (default: equal)",
       [](const Value& v, DeclaredFrame& f) { f.stiffness_ratio = v.numbers(); }},
      {"stiffness_over_mass_per_s2", "of ratio 1 over mass 1, where known (default: fitted)",
       [](const Value& v, DeclaredFrame& f) { f.stiffness_over_mass_per_s2 = v.number(1e-6, 1e12); }},
      {"data", "measured | simulated: where the reference comes from (default: measured)",
       [](const Value& v, DeclaredFrame& f) {
         if (v.text() != "measured" && v.text() != "simulated")
           v.refuse(fmt::format("`{}` is not known; write measured or simulated", printable(v.text())));
         f.simulated = v.text() == "simulated";
       }},
      {"dt_s", "time step of that simulation, where known",
       [](const Value& v, DeclaredFrame& f) { f.dt_s = v.number(1e-9, 1e3); }},
      {"frequency_sigma_percent",
       "of reference frequencies that state none (default: 0.15;\n                              of a modal.json 1.2 "
       "sqrt(zeta / (2 pi f T)), if larger)",
       [](const Value& v, DeclaredFrame& f) { f.frequency_sigma = 0.01 * v.number(1e-4, 20.0); }},
      {"shape_sigma", "of shape components that state none, largest component 1 (default: 0.02)",
       [](const Value& v, DeclaredFrame& f) { f.shape_sigma = v.number(1e-4, 1.0); }},
      {"floors", "the reference's channels, lowest first: shapes are then compared as well",
       [](const Value& v, DeclaredFrame& f) { f.floors = v.names(); }}};
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
  std::vector<std::string> names;
  for (const Key& key : keys()) names.push_back(std::string("structure.") + key.name);
  DeclaredFrame frame;
  for (std::size_t i = 0; i < structure.keys.size(); ++i) {
    const std::string path = "structure." + structure.keys[i];
    const auto key =
        std::find_if(keys().begin(), keys().end(), [&](const Key& k) { return k.name == structure.keys[i]; });
    if (key == keys().end()) {
      throw FileError(fmt::format("{}:{}: {} is not known; {}", name, structure.key_lines[i], printable(path),
                                  suggest_key(path, names, "hovermodal closeloop --help")));
    }
    key->set(Value(structure.items[i], path, name), frame);
  }
  if (structure.find("storeys") == nullptr)
    throw FileError(fmt::format("{}:{}: structure.storeys is missing; say how many floors move", name, structure.line));
  if (frame.dt_s && !frame.simulated)
    throw FileError(fmt::format("{}:{}: structure.dt_s belongs to `data: simulated`; add it, or leave dt_s out", name,
                                structure.line));
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
