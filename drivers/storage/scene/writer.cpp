#include <fmt/format.h>

#include <algorithm>

#include "drivers/storage/json.h"
#include "drivers/storage/scene/key.h"
#include "drivers/storage/text_wrap.h"

namespace drivers {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t kCommentColumn = 40;

bool applies(const SceneKey& key, const SceneFile& file) { return !key.applies || key.applies(file); }

// "plates[].texture.mean" -> its list ("plates") and the rest; "" = of no list.
std::pair<std::string, std::string> split_list(const std::string& path) {
  const std::size_t at = path.find("[].");
  return at == std::string::npos ? std::pair<std::string, std::string>{"", path}
                                 : std::pair<std::string, std::string>{path.substr(0, at), path.substr(at + 3)};
}

Json& child(Json& root, const std::string& path) {
  Json* node = &root;
  std::size_t from = 0;
  for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', from)) {
    node = &(*node)[path.substr(from, dot - from)];
    from = dot + 1;
  }
  return (*node)[path.substr(from)];
}

// One line of YAML: {name: base, size_mm: [300, 50]}.
std::string flow(const Json& value) {
  std::string text;
  if (value.is_object()) {
    for (const auto& [key, item] : value.items()) text += (text.empty() ? "" : ", ") + key + ": " + flow(item);
    return "{" + text + "}";
  }
  if (value.is_array()) {
    for (const Json& item : value) text += (text.empty() ? "" : ", ") + flow(item);
    return "[" + text + "]";
  }
  if (value.is_number_float()) return fmt::format("{}", value.get<double>());
  if (!value.is_string()) return value.dump();
  const auto& word = value.get_ref<const std::string&>();
  const bool plain =
      !word.empty() && std::all_of(word.begin(), word.end(), [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; });
  return plain ? word : value.dump();
}

std::string comment_of(const SceneKey& key) {
  return key.unit.empty() ? key.meaning : fmt::format("{}; {}", key.unit, key.meaning);
}

class TextWriter {
 public:
  explicit TextWriter(SceneFile& file) : file_(file) {}

  [[nodiscard]] std::string write() {
    for (const SceneKey& key : scene_keys()) {
      const auto [list, member] = split_list(key.path);
      if (!list.empty()) {
        write_list_member(key, list, member);
      } else {
        finish_list();
        if (applies(key, file_)) write_key(key);
      }
    }
    finish_list();
    return std::move(text_);
  }

 private:
  // Headings of the sections that contain the key.
  std::size_t open(const std::string& path) {
    std::size_t depth = 0;
    for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', dot + 1), ++depth) {
      const std::string section = path.substr(0, dot);
      if (std::find(opened_.begin(), opened_.end(), section) != opened_.end()) continue;
      opened_.push_back(section);
      text_ += fmt::format("{}{}{}:\n", depth == 0 ? "\n" : "", std::string(2 * depth, ' '),
                           section.substr(section.rfind('.') + 1));
    }
    return depth;
  }

  void write_line(const std::string& line, const std::string& comment) {
    text_ += fmt::format("{:<{}} # {}\n", line, kCommentColumn, comment);
  }

  void write_key(const SceneKey& key) {
    const std::size_t depth = open(key.path);
    const std::string name = key.path.substr(key.path.rfind('.') + 1);
    write_line(std::string(2 * depth, ' ') + name + ": " + flow(key.get(file_, 0)), comment_of(key));
  }

  // Comments on the members first, then one line per item.
  void write_list_member(const SceneKey& key, const std::string& list, const std::string& member) {
    if (list != list_) {
      finish_list();
      list_ = list;
      items_.assign(find_scene_list(list)->size(file_), Json::object());
      const std::size_t depth = open(list);
      list_indent_ = std::string(2 * depth, ' ');
      text_ += fmt::format("{}{}{}:{}\n", depth == 0 ? "\n" : "", list_indent_, list.substr(list.rfind('.') + 1),
                           items_.empty() ? " []" : "");
    }
    text_ += fmt::format("{}  # {}: {}\n", list_indent_, member, comment_of(key));
    for (std::size_t i = 0; i < items_.size(); ++i) child(items_[i], member) = key.get(file_, i);
  }
  void finish_list() {
    for (const Json& item : items_) text_ += fmt::format("{}  - {}\n", list_indent_, flow(item));
    items_.clear();
    list_.clear();
  }

  SceneFile& file_;
  std::string text_;
  std::vector<std::string> opened_;
  std::string list_, list_indent_;
  std::vector<Json> items_;
};

// The value of a key in the paper's scene; for members of a list, that of a new item.
std::string default_of(const SceneKey& key) {
  SceneFile file = preset_scene();
  const std::string list = split_list(key.path).first;
  if (!list.empty()) find_scene_list(list)->resize(file, 1);
  const std::string text = flow(key.get(file, 0));
  return text == "\"\"" || text == "[]" ? "none" : text;
}

}  // namespace

std::string scene_text(const SceneFile& file) {
  SceneFile copy = file;  // keys reach their values for writing
  return "# A scene of `hovermodal simulate --scene FILE`, complete. Keys may be left out: the preset's value "
         "holds.\n" +
         TextWriter(copy).write();
}

Json scene_json(const SceneFile& file) {
  SceneFile copy = file;
  Json out = Json::object();
  for (const SceneKey& key : scene_keys()) {
    if (!applies(key, file)) continue;
    const auto [list, member] = split_list(key.path);
    if (list.empty()) {
      child(out, key.path) = key.get(copy, 0);
      continue;
    }
    Json& items = child(out, list);
    if (items.is_null()) items = Json::array();
    for (std::size_t i = 0; i < find_scene_list(list)->size(file); ++i) {
      if (items.size() <= i) items.push_back(Json::object());
      child(items[i], member) = key.get(copy, i);
    }
  }
  return out;
}

Json scene_value(const Json& scene, const std::string& key) {
  Json::json_pointer at;
  for (std::size_t from = 0; from <= key.size();) {
    const std::size_t dot = std::min(key.find('.', from), key.size());
    at /= key.substr(from, dot - from);
    from = dot + 1;
  }
  return scene.contains(at) ? scene.at(at) : Json();
}

std::string scene_help() {
  std::string out =
      "SCENE FILES (YAML) of `hovermodal simulate --scene FILE`; --print-scene writes a complete one.\n"
      "Unknown or repeated keys, wrong types and values out of range are refused. Defaults are the paper's scene.\n";
  std::string section;
  for (const SceneKey& key : scene_keys()) {
    const std::string its_section = key.path.substr(0, key.path.find_first_of(".["));
    if (its_section != section) out += '\n';
    section = its_section;
    out += fmt::format("{:<36} {}\n", key.path, key.unit.empty() ? key.type : key.type + ", " + key.unit);
    append_wrapped(out, key.meaning, 4);
    append_wrapped(out, fmt::format("default: {}   allowed: {}", default_of(key), key.allowed), 4);
  }
  return out;
}

}  // namespace drivers
