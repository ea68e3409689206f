#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/storage/limits.h"
#include "drivers/storage/text_file.h"

namespace drivers {

// A YAML document as a plain tree with line numbers. Built from parser events, so that features which yaml-cpp's own
// tree hides (duplicate keys, quotes) or expands (aliases) are detected and refused.
struct YamlNode {
  enum class Kind : std::uint8_t { kNull, kScalar, kList, kMap };
  Kind kind = Kind::kNull;
  int line = 1;
  bool quoted = false;            // a scalar in quotes: text, even if it looks like a number
  std::string text;               // of a scalar
  std::vector<YamlNode> items;    // of a list; of a map: the values, in file order
  std::vector<std::string> keys;  // of a map: one per item
  std::vector<int> key_lines;

  [[nodiscard]] const YamlNode* find(const std::string& key) const noexcept;  // nullptr = not there
};

struct YamlLimits {
  std::size_t max_bytes = Limits::kYamlBytes;
  std::size_t max_depth = 8;
  std::size_t max_nodes = 100000;
};

// One document. Throws FileError "NAME:LINE: ..." on anything else: invalid YAML, binary or empty text, tabs for
// indentation, duplicate keys, anchors and aliases, more than one document, exceeded limits.
[[nodiscard]] YamlNode parse_yaml(const std::string& text, const std::string& name, const YamlLimits& limits = {});
[[nodiscard]] YamlNode read_yaml_file(const std::string& path, const YamlLimits& limits = {});

}  // namespace drivers
