#include "drivers/storage/structure_value.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "drivers/storage/key_suggestion.h"

namespace drivers {

StructureMap::StructureMap(const YamlNode& node, std::string path, const std::string& file)
    : node_(node), path_(std::move(path)), file_(file) {
  if (node_.kind != YamlNode::Kind::kMap) refuse("expected keys and values: {key: value, ...}");
}

void StructureMap::refuse_at(int line, const std::string& path, const std::string& what) const {
  throw FileError(fmt::format("{}:{}: {}: {}", file_, line, path, what));
}
void StructureMap::refuse(const std::string& what) const { refuse_at(node_.line, path_, what); }
void StructureMap::refuse(const std::string& key, const std::string& what) const {
  const YamlNode* found = node_.find(key);
  refuse_at(found == nullptr ? node_.line : found->line, path_ + "." + key, what);
}

void StructureMap::allow(const std::vector<const char*>& keys) const {
  std::vector<std::string> names;
  for (const char* key : keys) names.push_back(path_ + "." + key);
  for (std::size_t i = 0; i < node_.keys.size(); ++i) {
    const std::string path = path_ + "." + node_.keys[i];
    if (std::find(names.begin(), names.end(), path) == names.end()) {
      throw FileError(fmt::format("{}:{}: {} is not known; {}", file_, node_.key_lines[i], printable(path),
                                  suggest_key(path, names, "hovermodal closeloop --help")));
    }
  }
}

const YamlNode& StructureMap::at(const std::string& key) const {
  const YamlNode* found = node_.find(key);
  if (found == nullptr) refuse(key, "is missing");
  return *found;
}

double StructureMap::in_range(const YamlNode& node, const std::string& path, double low, double high) const {
  const auto value = node.kind == YamlNode::Kind::kScalar ? parse_number(node.text) : std::nullopt;
  if (!value)
    refuse_at(node.line, path, fmt::format("`{}` is no number; write a decimal number", printable(node.text)));
  if (!(*value >= low && *value <= high))
    refuse_at(node.line, path, fmt::format("{} is refused: allowed {:g} .. {:g}", printable(node.text), low, high));
  return *value;
}

double StructureMap::number(const std::string& key, double low, double high) const {
  return in_range(at(key), path_ + "." + key, low, high);
}
double StructureMap::number_or(const std::string& key, double low, double high, double fallback) const {
  return has(key) ? number(key, low, high) : fallback;
}
std::size_t StructureMap::whole_or(const std::string& key, double low, double high, std::size_t fallback) const {
  if (!has(key)) return fallback;
  const double value = number(key, low, high);
  if (value != std::floor(value)) refuse(key, fmt::format("{:g} is no whole number", value));
  return static_cast<std::size_t>(value);
}

std::string StructureMap::text(const std::string& key) const {
  const YamlNode& node = at(key);
  if (node.kind != YamlNode::Kind::kScalar || node.text.empty()) refuse(key, "expected one value");
  return node.text;
}
std::string StructureMap::text_or(const std::string& key, const std::string& fallback) const {
  return has(key) ? text(key) : fallback;
}
std::string StructureMap::one_of(const std::string& key, std::initializer_list<const char*> names) const {
  const std::string value = text_or(key, *names.begin());
  if (std::find(names.begin(), names.end(), value) == names.end())
    refuse(key, fmt::format("`{}` is not known; write {}", printable(value), fmt::join(names, " or ")));
  return value;
}

std::vector<double> StructureMap::numbers(const std::string& key, double low, double high, std::size_t n) const {
  const YamlNode& node = at(key);
  if (node.kind != YamlNode::Kind::kList) refuse(key, "expected a list: [.., ..]");
  if (n > 0 && node.items.size() != n) refuse(key, fmt::format("{} values, {} are expected", node.items.size(), n));
  std::vector<double> out;
  for (const YamlNode& item : node.items) out.push_back(in_range(item, path_ + "." + key, low, high));
  return out;
}

std::vector<std::string> StructureMap::texts(const std::string& key) const {
  std::vector<std::string> out;
  if (!has(key)) return out;
  const YamlNode& node = at(key);
  if (node.kind != YamlNode::Kind::kList) refuse(key, "expected a list of names");
  for (const YamlNode& item : node.items) {
    if (item.kind != YamlNode::Kind::kScalar || item.text.empty()) refuse(key, "expected a list of names");
    out.push_back(item.text);
  }
  return out;
}

StructureMap StructureMap::map(const std::string& key) const { return {at(key), path_ + "." + key, file_}; }

std::vector<StructureMap> StructureMap::maps(const std::string& key) const {
  std::vector<StructureMap> out;
  if (!has(key)) return out;
  const YamlNode& node = at(key);
  if (node.kind != YamlNode::Kind::kList) refuse(key, "expected a list of maps: [{...}, {...}]");
  for (std::size_t i = 0; i < node.items.size(); ++i)
    out.emplace_back(node.items[i], fmt::format("{}.{}[{}]", path_, key, i), file_);
  return out;
}

}  // namespace drivers
