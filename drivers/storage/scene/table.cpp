#include <algorithm>

#include "drivers/storage/key_suggestion.h"
#include "drivers/storage/scene/key.h"

namespace drivers {
namespace {

std::vector<SceneKey> build_keys() {
  std::vector<SceneKey> keys;
  add_camera_keys(keys);
  add_structure_keys(keys);
  add_plate_keys(keys);
  add_excitation_keys(keys);
  add_motion_keys(keys);
  add_injected_keys(keys);
  add_record_keys(keys);
  return keys;
}

}  // namespace

const std::vector<SceneKey>& scene_keys() {
  static const std::vector<SceneKey> keys = build_keys();
  return keys;
}

const SceneKey* find_scene_key(const std::string& path) {
  const auto& keys = scene_keys();
  const auto found = std::find_if(keys.begin(), keys.end(), [&](const SceneKey& key) { return key.path == path; });
  return found == keys.end() ? nullptr : &*found;
}

const SceneList* find_scene_list(const std::string& path) {
  const auto& lists = scene_lists();
  const auto found = std::find_if(lists.begin(), lists.end(), [&](const SceneList& list) { return list.path == path; });
  return found == lists.end() ? nullptr : &*found;
}

bool is_scene_section(const std::string& path) {
  return std::any_of(scene_keys().begin(), scene_keys().end(),
                     [&](const SceneKey& key) { return key.path.starts_with(path + "."); });
}

std::string suggest_scene_key(const std::string& path) {
  std::vector<std::string> keys;
  for (const SceneKey& key : scene_keys()) keys.push_back(key.path);
  return suggest_key(path, keys, "--help-scene");
}

}  // namespace drivers
