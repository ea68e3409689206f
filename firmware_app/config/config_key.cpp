#include "firmware_app/config/config_key.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <nlohmann/json.hpp>

namespace app {
namespace {

using drivers::YamlNode;
using Remedy = std::optional<std::string>;

Remedy read_number(const YamlNode& node, double& out) {
  if (auto remedy = refuse_unless_scalar(node)) return remedy;
  if (node.quoted) return "it is a text: remove the quotes";
  const auto value = drivers::parse_number(node.text);
  if (!value) return "write one finite decimal number, without unit";
  out = *value;
  return std::nullopt;
}

Remedy out_of_range(double value, const NumberRange& range) {
  if (range.holds(value)) return std::nullopt;
  return value < range.low ? "write a larger number" : "write a smaller number";
}

std::string quoted_if_needed(const std::string& text) { return text.empty() ? "\"\"" : text; }

}  // namespace

std::string NumberRange::text() const {
  return fmt::format("{}{} .. {}", or_zero && low > 0.0 ? "0 or " : "", low, high);
}

std::optional<std::string> refuse_unless_scalar(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::kScalar:
      return std::nullopt;
    case YamlNode::Kind::kNull:
      return "write a value, or remove the key to get its default";
    case YamlNode::Kind::kList:
      return "write a single value, not a list";
    case YamlNode::Kind::kMap:
      return "write a single value, not a section";
  }
  return "write a value";
}

std::optional<std::string> refuse_text(const std::string& text, const TextRule& rule) {
  if (text.size() < rule.min_length) return "write a longer text";
  if (text.size() > rule.max_length) return "write a shorter text";
  const bool is_plain = std::all_of(text.begin(), text.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.';
  });
  if (rule.plain && !is_plain) return "use letters a-z A-Z, digits and _ - . only";
  if (text.find('\0') != std::string::npos || text.find('\n') != std::string::npos) return "write it on one line";
  return std::nullopt;
}

ConfigKey number_key(std::string path, std::string unit, Field<double> field, NumberRange range, std::string meaning) {
  ConfigKey key{std::move(path), "number", std::move(unit), range.text(), "", std::move(meaning), {}, {}};
  key.set = [=](AppConfig& config, std::size_t i, const YamlNode& node) -> Remedy {
    double value = 0.0;
    if (auto remedy = read_number(node, value)) return remedy;
    if (auto remedy = out_of_range(value, range)) return remedy;
    return field(config, i) = value, std::nullopt;
  };
  key.canonical = [=](AppConfig& config, std::size_t i) { return fmt::format("{}", field(config, i)); };
  return key;
}

ConfigKey whole_key(std::string path, std::string unit, Field<int> field, NumberRange range, std::string meaning) {
  ConfigKey key{std::move(path), "whole number", std::move(unit), range.text(), "", std::move(meaning), {}, {}};
  key.set = [=](AppConfig& config, std::size_t i, const YamlNode& node) -> Remedy {
    double number = 0.0;
    if (auto remedy = read_number(node, number)) return remedy;
    const auto value = drivers::parse_whole(node.text);
    if (auto remedy = out_of_range(number, range)) return remedy;
    if (!value) return "write a whole number, without point or exponent";
    return field(config, i) = static_cast<int>(*value), std::nullopt;
  };
  key.canonical = [=](AppConfig& config, std::size_t i) { return fmt::format("{}", field(config, i)); };
  return key;
}

ConfigKey seed_key(std::string path, Field<std::uint64_t> field, std::string meaning) {
  const std::string allowed = fmt::format("0 .. {}", std::numeric_limits<std::uint64_t>::max());
  ConfigKey key{std::move(path), "whole number", "", allowed, "", std::move(meaning), {}, {}};
  key.set = [=](AppConfig& config, std::size_t i, const YamlNode& node) -> Remedy {
    if (auto remedy = refuse_unless_scalar(node)) return remedy;
    const auto value = node.quoted ? std::nullopt : drivers::parse_unsigned(node.text);
    if (!value) return "write a whole number, not negative";
    return field(config, i) = *value, std::nullopt;
  };
  key.canonical = [=](AppConfig& config, std::size_t i) { return fmt::format("{}", field(config, i)); };
  return key;
}

ConfigKey switch_key(std::string path, Field<bool> field, std::string meaning) {
  return choice_key<bool>(std::move(path), std::move(field), {{"true", true}, {"false", false}}, std::move(meaning));
}

ConfigKey text_key(std::string path, Field<std::string> field, TextRule rule, std::string meaning) {
  std::string allowed = fmt::format("{} .. {} {}", rule.min_length, rule.max_length,
                                    rule.plain ? "letters, digits, _ - ." : "characters");
  ConfigKey key{std::move(path), "text", "", std::move(allowed), "", std::move(meaning), {}, {}};
  key.set = [=](AppConfig& config, std::size_t i, const YamlNode& node) -> Remedy {
    if (auto remedy = refuse_unless_scalar(node)) return remedy;
    if (auto remedy = refuse_text(node.text, rule)) return remedy;
    return field(config, i) = node.text, std::nullopt;
  };
  key.canonical = [=](AppConfig& config, std::size_t i) { return quoted_if_needed(field(config, i)); };
  return key;
}

ConfigKey texts_key(std::string path, Field<std::vector<std::string>> field, TextRule rule, std::string meaning) {
  std::string allowed =
      rule.plain ? fmt::format("[] or [name, ...], each 1 .. {} letters, digits, _ - .", rule.max_length)
                 : fmt::format("[] or [text, ...], at most {}, each 1 .. {} bytes", rule.max_items, rule.max_length);
  ConfigKey key{std::move(path), "list of texts", "", std::move(allowed), "", std::move(meaning), {}, {}};
  key.set = [=](AppConfig& config, std::size_t i, const YamlNode& node) -> Remedy {
    if (node.kind != YamlNode::Kind::kList) return "write a list: [name, name]";
    if (node.items.size() > rule.max_items) return fmt::format("write at most {} texts", rule.max_items);
    std::vector<std::string> texts;
    for (const YamlNode& item : node.items) {
      if (auto remedy = refuse_unless_scalar(item)) return remedy;
      if (auto remedy = refuse_text(item.text, rule)) return remedy;
      if (std::find(texts.begin(), texts.end(), item.text) != texts.end()) return "write each name once";
      texts.push_back(item.text);
    }
    return field(config, i) = std::move(texts), std::nullopt;
  };
  // Plain texts need no quotes; a JSON string is also a YAML string.
  key.canonical = [=](AppConfig& config, std::size_t i) {
    return rule.plain ? fmt::format("[{}]", fmt::join(field(config, i), ", "))
                      : nlohmann::json(field(config, i)).dump();
  };
  return key;
}

ConfigKey text_choice_key(std::string path, Field<std::string> field, std::vector<std::string> choices,
                          std::string meaning) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const std::string& choice : choices) pairs.emplace_back(choice, choice);
  return choice_key<std::string>(std::move(path), std::move(field), std::move(pairs), std::move(meaning));
}

ConfigKey numbers_key(std::string path, std::string unit, NumberList list, std::string allowed, std::string meaning) {
  ConfigKey key{
      std::move(path), "list of numbers", std::move(unit), std::move(allowed), "", std::move(meaning), {}, {}};
  key.set = [list](AppConfig& config, std::size_t i, const YamlNode& node) -> Remedy {
    const std::size_t n_max = list.ranges.size();
    if (node.kind != YamlNode::Kind::kList || node.items.size() < list.n_min || node.items.size() > n_max) {
      return list.n_min == n_max ? fmt::format("write a list of {} numbers", n_max)
                                 : fmt::format("write a list of {} to {} numbers", list.n_min, n_max);
    }
    std::vector<double> values(node.items.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (auto remedy = read_number(node.items[k], values[k])) return fmt::format("number {}: {}", k + 1, *remedy);
      if (auto remedy = out_of_range(values[k], list.ranges[k])) return fmt::format("number {}: {}", k + 1, *remedy);
    }
    list.put(config, i, values);
    return std::nullopt;
  };
  key.canonical = [list](AppConfig& config, std::size_t i) {
    return fmt::format("[{}]", fmt::join(list.get(config, i), ", "));
  };
  return key;
}

ConfigKey rows_key(std::string path, std::string unit, NumberRows rows, std::string allowed, std::string meaning) {
  ConfigKey key{std::move(path), "list of rows", std::move(unit), std::move(allowed), "", std::move(meaning), {}, {}};
  key.set = [rows](AppConfig& config, std::size_t, const YamlNode& node) -> Remedy {
    const std::size_t n = node.items.size();
    if (node.kind != YamlNode::Kind::kList || (n > 0 && n < rows.n_min) || n > rows.n_max)
      return fmt::format("write [] or {} to {} rows, each a list in brackets", rows.n_min, rows.n_max);
    std::vector<std::vector<double>> values(n, std::vector<double>(rows.ranges.size()));
    for (std::size_t i = 0; i < n; ++i) {
      const YamlNode& row = node.items[i];
      if (row.kind != YamlNode::Kind::kList || row.items.size() != rows.ranges.size())
        return fmt::format("row {}: write a list of {} numbers", i + 1, rows.ranges.size());
      for (std::size_t k = 0; k < rows.ranges.size(); ++k) {
        if (auto remedy = read_number(row.items[k], values[i][k]))
          return fmt::format("row {}, number {}: {}", i + 1, k + 1, *remedy);
        if (auto remedy = out_of_range(values[i][k], rows.ranges[k]))
          return fmt::format("row {}, number {}: {}", i + 1, k + 1, *remedy);
      }
    }
    rows.put(config, values);
    return std::nullopt;
  };
  key.canonical = [rows](AppConfig& config, std::size_t) {
    std::string text;
    for (const std::vector<double>& row : rows.get(config))
      text += fmt::format("{}[{}]", text.empty() ? "" : ", ", fmt::join(row, ", "));
    return "[" + text + "]";
  };
  return key;
}

ConfigKey pair_key(std::string path, std::string unit, Field<std::array<double, 2>> field, NumberRange range,
                   std::string meaning) {
  NumberList list;
  list.ranges = {range, range};
  list.n_min = 2;
  list.put = [field](AppConfig& config, std::size_t i, const std::vector<double>& v) {
    field(config, i) = {v[0], v[1]};
  };
  list.get = [field](AppConfig& config, std::size_t i) {
    const std::array<double, 2>& v = field(config, i);
    return std::vector<double>(v.begin(), v.end());
  };
  return numbers_key(std::move(path), std::move(unit), std::move(list), "[u, v], each " + range.text(),
                     std::move(meaning));
}

}  // namespace app
