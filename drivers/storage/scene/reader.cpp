#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "core/simulation/presets.h"
#include "drivers/storage/scene/key.h"

namespace drivers {
namespace {

constexpr std::size_t kMostItems = 65;

std::string shown(const YamlNode& node) {
  if (node.kind == YamlNode::Kind::kNull) return "nothing";
  if (node.kind == YamlNode::Kind::kMap) return "a section";
  if (node.kind == YamlNode::Kind::kList) {
    std::string text;
    for (const YamlNode& item : node.items) text += (text.empty() ? "" : ", ") + shown(item);
    return fmt::format("[{}]", printable(text));
  }
  return node.quoted || node.text.empty() ? fmt::format("\"{}\"", printable(node.text)) : printable(node.text);
}

// Path of a key: as written ("plates.0.name") and as in the table ("plates[].name").
struct Place {
  std::string written, table;
  std::size_t i = 0;
  [[nodiscard]] Place child(const std::string& key) const {
    return {written.empty() ? key : written + "." + key, table.empty() ? key : table + "." + key, i};
  }
};

// The section to which a refusal of core::simulation::validate refers, by words of its message; the first match.
std::string section_of(const std::string& message) {
  static const std::pair<const char*, const char*> kWords[] = {{"simulation: structure:", "structure"},
                                                               {"edge of the structure", "camera"},
                                                               {"distance from the camera", "camera"},
                                                               {"the background", "background"},
                                                               {"plate", "plates"},
                                                               {"flight", "flight"},
                                                               {"base peak", "excitation"},
                                                               {"harmonic", "excitation"},
                                                               {"input band", "excitation"},
                                                               {"weight of", "excitation"},
                                                               {"last body", "excitation"},
                                                               {"rotor", "rotor"},
                                                               {"vibration", "rotor"},
                                                               {"drift", "hover"},
                                                               {"rotation (rad", "hover"},
                                                               {"zoom", "hover"},
                                                               {"jitter", "timing"},
                                                               {"probability of a d", "timing"},
                                                               {"light", "light"},
                                                               {"flicker", "light"},
                                                               {"channel", "channels"},
                                                               {"track", "tracks"},
                                                               {"point", "tracks"},
                                                               {"duration", "duration_s"}};
  for (const auto& [word, section] : kWords) {
    if (message.find(word) != std::string::npos) return section;
  }
  return "camera";
}

class Reader {
 public:
  Reader(std::string file_name, std::string folder, const SceneOverrides& overrides)
      : file_name_(std::move(file_name)), folder_(std::move(folder)), overrides_(overrides) {}

  [[nodiscard]] SceneFile read(const YamlNode& root) {
    start(root);
    take_section(root, {});
    refuse_idle_keys();
    check_plate_names();
    // The following values are computed from several keys: the message names the section, preceded by the file's name.
    try {
      build();
      core::simulation::validate(file_.scene);
    } catch (const std::invalid_argument& error) {
      refuse_scene(error.what());
    }
    return std::move(file_);
  }

 private:
  [[noreturn]] void refuse(int line, const std::string& what) const {
    throw std::invalid_argument(fmt::format("{}:{}: {}", file_name_, line, what));
  }
  [[noreturn]] void refuse_value(const YamlNode& node, const Place& place, const std::string& allowed,
                                 const std::string& remedy) const {
    const std::string key = place.written.empty() ? std::string("the file") : printable(place.written, 100);
    refuse(node.line, fmt::format("{}: {} is refused: allowed {}; {}", key, shown(node), allowed, remedy));
  }
  [[noreturn]] void refuse_scene(const std::string& message) const {
    const std::string section = section_of(message);
    std::string text = message;
    for (const std::string& known : {std::string("simulation: "), section + ": "}) {
      if (text.starts_with(known)) text = text.substr(known.size());
    }
    const auto line = lines_.find(section);
    if (line != lines_.end()) refuse(line->second, fmt::format("{}: {}", section, text));
    throw std::invalid_argument(file_name_.empty() ? message : fmt::format("{}: {}: {}", file_name_, section, text));
  }

  void start(const YamlNode& root) {
    std::string preset = overrides_.preset.value_or("paper");
    for (const char* first : {"seed", "duration_s", "preset"}) {
      const YamlNode* node = root.kind == YamlNode::Kind::kMap ? root.find(first) : nullptr;
      if (node != nullptr) take(*node, Place{first, first});
    }
    if (!overrides_.preset && lines_.contains("preset")) preset = file_.preset;
    if (overrides_.seed) file_.scene.seed = *overrides_.seed;
    if (overrides_.duration_s) file_.scene.duration_s = *overrides_.duration_s;
    start_from_preset(file_, preset);
  }

  void take_section(const YamlNode& node, const Place& place) {
    if (node.kind == YamlNode::Kind::kNull) return;  // a section whose keys are all commented out
    if (node.kind != YamlNode::Kind::kMap) {
      refuse_value(node, place, "a section with `key: value` lines", "--print-scene shows an example");
    }
    for (std::size_t i = 0; i < node.keys.size(); ++i) {
      const Place child = place.child(node.keys[i]);
      const bool known = node.keys[i].find_first_of(".[") == std::string::npos &&
                         (find_scene_key(child.table) != nullptr || is_scene_section(child.table) ||
                          find_scene_list(child.table) != nullptr);
      if (!known) {
        refuse(node.key_lines[i],
               fmt::format("{}: unknown key; {}", printable(child.written, 100), suggest_scene_key(child.table)));
      }
      lines_[child.written] = node.key_lines[i];
      if (place.table.empty() && (child.table == "seed" || child.table == "duration_s" || child.table == "preset")) {
        continue;  // already handled
      }
      take(node.items[i], child);
    }
  }

  void take(const YamlNode& node, const Place& place) {
    const SceneKey* key = find_scene_key(place.table);
    const SceneList* list = find_scene_list(place.table);
    if (list != nullptr && (node.kind == YamlNode::Kind::kList || !is_scene_section(place.table))) {
      return take_list(node, place, *list);
    }
    if (key == nullptr) return take_section(node, place);
    if (const auto remedy = key->set(file_, place.i, node)) {
      const std::string unit = key->unit.empty() ? "" : fmt::format(" ({})", key->unit);
      refuse_value(node, place, key->allowed + unit, *remedy);
    }
    lines_[place.written] = node.line;
  }

  void take_list(const YamlNode& node, const Place& place, const SceneList& list) {
    if (node.kind != YamlNode::Kind::kList) refuse_value(node, place, "a list", "write `- {key: value}` lines, or []");
    if (node.items.size() > kMostItems) {
      refuse_value(node, place, fmt::format("at most {} of them", kMostItems), "remove some");
    }
    list.resize(file_, node.items.size());
    for (std::size_t i = 0; i < node.items.size(); ++i) {
      const Place item{fmt::format("{}.{}", place.written, i), place.table + "[]", i};
      lines_[item.written] = node.items[i].line;
      if (node.items[i].kind != YamlNode::Kind::kMap) {
        refuse_value(node.items[i], item, "a section", "write `- {key: value}`");
      }
      take_section(node.items[i], item);
    }
  }

  // Keys of another type of structure would be ignored, which is rarely intended.
  void refuse_idle_keys() const {
    for (const auto& [path, line] : lines_) {
      const SceneKey* key = find_scene_key(path);
      if (key == nullptr || !key->applies || !path.starts_with("structure.") || key->applies(file_)) continue;
      refuse(line, fmt::format("{}: has no meaning for this type of structure or damping; remove it, or change "
                               "structure.type or structure.damping.kind",
                               path));
    }
  }

  void check_plate_names() const {
    std::vector<std::string> taken{"background"};
    for (std::size_t i = 0; i < file_.scene.plates.size(); ++i) {
      const std::string& name = file_.scene.plates[i].name;
      if (!name.empty() && std::find(taken.begin(), taken.end(), name) == taken.end()) {
        taken.push_back(name);
        continue;
      }
      const auto line = lines_.find(fmt::format("plates.{}", i));
      refuse(line == lines_.end() ? 1 : line->second,
             fmt::format("plates.{}.name: \"{}\" is refused: allowed a name that no other plate has, nor `background`; "
                         "give each plate its own",
                         i, name));
    }
  }

  [[nodiscard]] bool is_written(std::string_view section) const {
    const auto next = lines_.lower_bound(std::string(section) + ".");
    return next != lines_.end() && next->first.starts_with(std::string(section) + ".");
  }

  void build() {
    const bool listed = lines_.contains("plates.0");
    if (is_written("structure")) build_structure(file_);
    const bool other_bodies = file_.scene.n_bodies() != file_.scene.structure.n_bodies() + 1;
    if (!listed && (is_written("plates") || (is_written("structure") && other_bodies))) make_plates(file_);
    core::simulation::CameraParameters& camera = file_.scene.camera;
    if (!is_centred_by_file()) {
      camera.cx_px = 0.5 * (camera.width_px - 1);
      camera.cy_px = 0.5 * (camera.height_px - 1);
    }
    core::simulation::settle_textures(file_.scene);
    if (overrides_.width_px && overrides_.height_px) {
      core::simulation::set_image_size(file_.scene, *overrides_.width_px, *overrides_.height_px);
    }
    load_flight(file_, folder_);
  }
  [[nodiscard]] bool is_centred_by_file() const {
    const bool resized = lines_.contains("camera.width_px") || lines_.contains("camera.height_px");
    return lines_.contains("camera.centre_px") || !resized;
  }

  std::string file_name_, folder_;
  const SceneOverrides& overrides_;
  SceneFile file_;
  std::map<std::string, int> lines_;  // of every key and section, as written
};

}  // namespace

SceneFile parse_scene(const std::string& text, const std::string& name, const SceneOverrides& overrides,
                      const std::string& folder) {
  YamlNode root;
  try {
    root = parse_yaml(text, name);
  } catch (const FileError& error) {
    throw std::invalid_argument(error.what());
  }
  if (root.kind == YamlNode::Kind::kNull) {
    throw std::invalid_argument(name + ": is empty; --print-scene shows an example");
  }
  return Reader(name, folder, overrides).read(root);
}

SceneFile read_scene_file(const std::string& path, const SceneOverrides& overrides) {
  std::string text;
  try {
    text = read_text_file(path, YamlLimits{}.max_bytes);
  } catch (const FileError& error) {
    throw std::invalid_argument(error.what());
  }
  return parse_scene(text, path, overrides, std::filesystem::path(path).parent_path().string());
}

SceneFile preset_scene(const SceneOverrides& overrides) { return Reader("", "", overrides).read(YamlNode{}); }

}  // namespace drivers
