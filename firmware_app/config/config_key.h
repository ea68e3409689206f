#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/storage/yaml.h"
#include "firmware_app/config/config.h"

namespace app {

// One key of the configuration: the basis of parsing, checking, --help-config and the canonical text of the hash.
struct ConfigKey {
  std::string path;          // "camera.rate_hz"; members of the list of regions are "regions[].name"
  std::string type;          // "number", "whole number", "text", "true | false", "one of", ...
  std::string unit;          // empty = none
  std::string allowed;       // "1 .. 100", "paper | hovermodal"
  std::string default_text;  // empty = the value of a default AppConfig
  std::string meaning;       // one line
  // Stores the value in the configuration; `i_region` is used by regions[] keys only. A returned text means refusal and
  // states the remedy.
  std::function<std::optional<std::string>(AppConfig&, std::size_t i_region, const drivers::YamlNode&)> set;
  std::function<std::string(AppConfig&, std::size_t i_region)> canonical;  // the value as written in canonical text
};

// Member of the configuration that holds a key's value.
template <class T>
using Field = std::function<T&(AppConfig&, std::size_t i_region)>;

template <class Section, class T>
Field<T> at(Section AppConfig::*section, T Section::*member) {
  return [=](AppConfig& config, std::size_t) -> T& { return config.*section.*member; };
}
template <class T>
Field<T> at(T core::Region::*member) {
  return [=](AppConfig& config, std::size_t i_region) -> T& { return config.regions[i_region].*member; };
}

struct NumberRange {
  double low;
  double high;
  bool or_zero = false;  // 0 is allowed too: "automatic" or "unknown"
  [[nodiscard]] bool holds(double value) const noexcept {
    return (value >= low && value <= high) || (or_zero && value == 0.0);
  }
  [[nodiscard]] std::string text() const;
};

// Allowed texts. `plain`: letters, digits, _ - . only (names end in file columns and LCM channels).
struct TextRule {
  std::size_t min_length = 0;
  std::size_t max_length = 4096;
  bool plain = false;
  std::size_t max_items = 4096;  // of a list of texts
};

[[nodiscard]] ConfigKey number_key(std::string path, std::string unit, Field<double> field, NumberRange range,
                                   std::string meaning);
[[nodiscard]] ConfigKey whole_key(std::string path, std::string unit, Field<int> field, NumberRange range,
                                  std::string meaning);
[[nodiscard]] ConfigKey seed_key(std::string path, Field<std::uint64_t> field, std::string meaning);
[[nodiscard]] ConfigKey switch_key(std::string path, Field<bool> field, std::string meaning);
[[nodiscard]] ConfigKey text_key(std::string path, Field<std::string> field, TextRule rule, std::string meaning);
[[nodiscard]] ConfigKey texts_key(std::string path, Field<std::vector<std::string>> field, TextRule rule,
                                  std::string meaning);
[[nodiscard]] ConfigKey text_choice_key(std::string path, Field<std::string> field, std::vector<std::string> choices,
                                        std::string meaning);

// `get` and `put` access the numbers of a list; `ranges` has one entry per number, the first `n_min` are required.
struct NumberList {
  std::vector<NumberRange> ranges;
  std::size_t n_min;
  std::function<void(AppConfig&, std::size_t, const std::vector<double>&)> put;
  std::function<std::vector<double>(AppConfig&, std::size_t)> get;
};
[[nodiscard]] ConfigKey numbers_key(std::string path, std::string unit, NumberList list, std::string allowed,
                                    std::string meaning);
// A list of rows of numbers, one range per column; `n_min` 0: [] is allowed.
struct NumberRows {
  std::vector<NumberRange> ranges;
  std::size_t n_min, n_max;  // limits of the number of rows, unless empty
  std::function<void(AppConfig&, const std::vector<std::vector<double>>&)> put;
  std::function<std::vector<std::vector<double>>(AppConfig&)> get;
};
[[nodiscard]] ConfigKey rows_key(std::string path, std::string unit, NumberRows rows, std::string allowed,
                                 std::string meaning);
// A fixed number of values in one range, stored in an array.
[[nodiscard]] ConfigKey pair_key(std::string path, std::string unit, Field<std::array<double, 2>> field,
                                 NumberRange range, std::string meaning);

// Helpers of keys with their own rules.
[[nodiscard]] std::optional<std::string> refuse_unless_scalar(const drivers::YamlNode& node);
[[nodiscard]] std::optional<std::string> refuse_text(const std::string& text, const TextRule& rule);

template <class E>
ConfigKey choice_key(std::string path, Field<E> field, std::vector<std::pair<std::string, E>> choices,
                     std::string meaning) {
  ConfigKey key;
  key.path = std::move(path);
  key.type = "one of";
  key.meaning = std::move(meaning);
  for (const auto& [name, value] : choices) key.allowed += (key.allowed.empty() ? "" : " | ") + name;
  key.set = [field, choices](AppConfig& config, std::size_t i,
                             const drivers::YamlNode& node) -> std::optional<std::string> {
    if (auto remedy = refuse_unless_scalar(node)) return remedy;
    for (const auto& [name, value] : choices) {
      if (name == node.text) return field(config, i) = value, std::nullopt;
    }
    return "write one of these words";
  };
  key.canonical = [field, choices](AppConfig& config, std::size_t i) {
    for (const auto& [name, value] : choices) {
      if (value == field(config, i)) return name;
    }
    return std::string();
  };
  return key;
}

// Choices by the table of names that the enum's own header holds.
template <class E, std::size_t kCount>
ConfigKey named_key(std::string path, Field<E> field, const std::array<std::pair<E, std::string_view>, kCount>& names,
                    std::string meaning) {
  std::vector<std::pair<std::string, E>> choices;
  for (const auto& [value, name] : names) choices.emplace_back(name, value);
  return choice_key<E>(std::move(path), std::move(field), std::move(choices), std::move(meaning));
}

}  // namespace app
