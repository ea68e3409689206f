#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/storage/scene/scene_file.h"
#include "drivers/storage/yaml.h"

namespace drivers {

// One key of scene files: the source of reading, --print-scene, --help-scene and the `scene` of truth.json.
struct SceneKey {
  std::string path;  // "camera.rate_hz"; members of a list are "plates[].name"
  std::string type, unit, allowed;
  std::string meaning;  // one line
  // Stores the value; `i` is the index in the list, if the key belongs to one. A returned text means refusal: the
  // remedy.
  std::function<std::optional<std::string>(SceneFile&, std::size_t i, const YamlNode&)> set;
  std::function<nlohmann::ordered_json(SceneFile&, std::size_t i)> get;
  std::function<bool(const SceneFile&)> applies;  // empty = always; otherwise written only where it has a meaning
};

// A list of sections, and its length.
struct SceneList {
  std::string path;  // "plates"
  std::function<void(SceneFile&, std::size_t n)> resize;
  std::function<std::size_t(const SceneFile&)> size;
};

template <class T>
using SceneField = std::function<T&(SceneFile&, std::size_t i)>;

// In a file the value is `per_unit` times the value in the scene (1e3: s as ms).
struct SceneRange {
  double low, high;
  double per_unit = 1.0;
};

[[nodiscard]] SceneKey scene_number(std::string path, std::string unit, SceneField<double> field, SceneRange range,
                                    std::string meaning);
[[nodiscard]] SceneKey scene_whole(std::string path, std::string unit, SceneField<int> field, SceneRange range,
                                   std::string meaning);
[[nodiscard]] SceneKey scene_seed(std::string path, SceneField<std::uint64_t> field, std::string meaning);
[[nodiscard]] SceneKey scene_name(std::string path, SceneField<std::string> field, std::string meaning);
[[nodiscard]] SceneKey scene_path(std::string path, SceneField<std::string> field, std::string meaning);
// One number per field; or, if fewer are allowed, at least n_min (the others 0).
[[nodiscard]] SceneKey scene_tuple(std::string path, std::string unit, std::vector<SceneField<double>> fields,
                                   std::size_t n_min, SceneRange range, std::string meaning);
[[nodiscard]] SceneKey scene_numbers(std::string path, std::string unit, SceneField<std::vector<double>> field,
                                     SceneRange range, std::string meaning);
[[nodiscard]] SceneKey scene_rows(std::string path, std::string unit, SceneField<SceneStructure::Rows> field,
                                  std::string meaning);
// true, false or a number in the range.
[[nodiscard]] SceneKey scene_declared(std::string path, std::string unit, SceneField<Declared> field, SceneRange range,
                                      std::string meaning);

template <class E>
SceneKey scene_choice(std::string path, SceneField<E> field, std::vector<std::pair<std::string, E>> choices,
                      std::string meaning) {
  SceneKey key{std::move(path), "one of", "", "", std::move(meaning), {}, {}, {}};
  for (const auto& choice : choices) key.allowed += (key.allowed.empty() ? "" : " | ") + choice.first;
  key.set = [field, choices](SceneFile& file, std::size_t i, const YamlNode& node) -> std::optional<std::string> {
    for (const auto& [name, value] : choices) {
      if (node.kind == YamlNode::Kind::kScalar && name == node.text) return field(file, i) = value, std::nullopt;
    }
    return "write one of these";
  };
  key.get = [field, choices](SceneFile& file, std::size_t i) -> nlohmann::ordered_json {
    for (const auto& [name, value] : choices) {
      if (value != field(file, i)) continue;
      if (name == "true" || name == "false") return name == "true";
      return name;
    }
    return nullptr;
  };
  return key;
}
[[nodiscard]] SceneKey scene_switch(std::string path, SceneField<bool> field, std::string meaning);

// The table, in the order of the file.
[[nodiscard]] const std::vector<SceneKey>& scene_keys();
[[nodiscard]] const std::vector<SceneList>& scene_lists();
void add_camera_keys(std::vector<SceneKey>& keys);
void add_structure_keys(std::vector<SceneKey>& keys);
void add_plate_keys(std::vector<SceneKey>& keys);
void add_excitation_keys(std::vector<SceneKey>& keys);
void add_motion_keys(std::vector<SceneKey>& keys);
void add_injected_keys(std::vector<SceneKey>& keys);
void add_record_keys(std::vector<SceneKey>& keys);

[[nodiscard]] const SceneKey* find_scene_key(const std::string& path);
[[nodiscard]] const SceneList* find_scene_list(const std::string& path);
[[nodiscard]] bool is_scene_section(const std::string& path);
// "did you mean `x`?" for an unknown key.
[[nodiscard]] std::string suggest_scene_key(const std::string& path);

// The preset's scene with the file's seed and duration, and its structure described.
void start_from_preset(SceneFile& file, const std::string& name);
// Values computed from the description: matrices, plates at the bodies, the flight (file names relative to
// `folder`). Throw std::invalid_argument.
void build_structure(SceneFile& file);
void make_plates(SceneFile& file);
void load_flight(SceneFile& file, const std::string& folder);

// A member of a section of the scene.
template <auto section, auto member>
auto& of(SceneFile& file, std::size_t) {
  return file.scene.*section.*member;
}

}  // namespace drivers
