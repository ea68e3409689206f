#include "drivers/storage/scene/key.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

namespace drivers {
namespace {

using Json = nlohmann::ordered_json;
using Remedy = std::optional<std::string>;
constexpr std::size_t kMostNumbers = 128;

Remedy read_number(const YamlNode& node, const SceneRange& range, double& out) {
  if (node.kind != YamlNode::Kind::kScalar) return "write a single number";
  if (node.quoted) return "it is a text: remove the quotes";
  const auto value = parse_number(node.text);
  if (!value) return "write one finite decimal number, without unit";
  if (*value < range.low) return "write a larger number";
  if (*value > range.high) return "write a smaller number";
  out = *value / range.per_unit;
  return std::nullopt;
}

// 15 digits where a unit was converted, so that a value read as 26 is written as 26.
Json written(double value, double per_unit) {
  if (per_unit == 1.0 || !std::isfinite(value)) return value;
  return parse_number(fmt::format("{:.15g}", value * per_unit)).value_or(value * per_unit);
}

std::string text_of(const SceneRange& range) { return fmt::format("{} .. {}", range.low, range.high); }

SceneKey start(std::string path, const char* type, std::string unit, std::string allowed, std::string meaning) {
  return {std::move(path), type, std::move(unit), std::move(allowed), std::move(meaning), {}, {}, {}};
}

Remedy read_numbers(const YamlNode& node, const SceneRange& range, std::vector<double>& out) {
  if (node.kind != YamlNode::Kind::kList) return "write a list: [1, 2, 3]";
  if (node.items.size() > kMostNumbers) return fmt::format("write at most {} numbers", kMostNumbers);
  out.resize(node.items.size());
  for (std::size_t k = 0; k < out.size(); ++k) {
    if (auto remedy = read_number(node.items[k], range, out[k])) return fmt::format("number {}: {}", k + 1, *remedy);
  }
  return std::nullopt;
}

Json written_list(const std::vector<double>& values, double per_unit) {
  Json list = Json::array();
  for (const double value : values) list.push_back(written(value, per_unit));
  return list;
}

}  // namespace

SceneKey scene_number(std::string path, std::string unit, SceneField<double> field, SceneRange range,
                      std::string meaning) {
  SceneKey key = start(std::move(path), "number", std::move(unit), text_of(range), std::move(meaning));
  key.set = [=](SceneFile& file, std::size_t i, const YamlNode& node) {
    return read_number(node, range, field(file, i));
  };
  key.get = [=](SceneFile& file, std::size_t i) { return written(field(file, i), range.per_unit); };
  return key;
}

SceneKey scene_whole(std::string path, std::string unit, SceneField<int> field, SceneRange range, std::string meaning) {
  SceneKey key = start(std::move(path), "whole number", std::move(unit), text_of(range), std::move(meaning));
  key.set = [=](SceneFile& file, std::size_t i, const YamlNode& node) -> Remedy {
    double number = 0.0;
    if (auto remedy = read_number(node, range, number)) return remedy;
    const auto value = parse_whole(node.text);
    if (!value) return "write a whole number, without point or exponent";
    return field(file, i) = static_cast<int>(*value), std::nullopt;
  };
  key.get = [=](SceneFile& file, std::size_t i) -> Json { return field(file, i); };
  return key;
}

SceneKey scene_seed(std::string path, SceneField<std::uint64_t> field, std::string meaning) {
  const std::string allowed = fmt::format("0 .. {}", std::numeric_limits<std::uint64_t>::max());
  SceneKey key = start(std::move(path), "whole number", "", allowed, std::move(meaning));
  key.set = [=](SceneFile& file, std::size_t i, const YamlNode& node) -> Remedy {
    const bool plain = node.kind == YamlNode::Kind::kScalar && !node.quoted;
    const auto value = plain ? parse_unsigned(node.text) : std::nullopt;
    if (!value) return "write a whole number, not negative";
    return field(file, i) = *value, std::nullopt;
  };
  key.get = [=](SceneFile& file, std::size_t i) -> Json { return field(file, i); };
  return key;
}

SceneKey scene_name(std::string path, SceneField<std::string> field, std::string meaning) {
  SceneKey key = start(std::move(path), "text", "", "1 .. 32 letters, digits, _ - .", std::move(meaning));
  key.set = [=](SceneFile& file, std::size_t i, const YamlNode& node) -> Remedy {
    if (node.kind != YamlNode::Kind::kScalar) return "write a name";
    const bool plain = std::all_of(node.text.begin(), node.text.end(), [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.';
    });
    if (!plain || node.text.empty() || node.text.size() > 32) return "use letters a-z A-Z, digits and _ - . only";
    return field(file, i) = node.text, std::nullopt;
  };
  key.get = [=](SceneFile& file, std::size_t i) -> Json { return field(file, i); };
  return key;
}

SceneKey scene_path(std::string path, SceneField<std::string> field, std::string meaning) {
  SceneKey key = start(std::move(path), "text", "", "a file; \"\" = none", std::move(meaning));
  key.set = [=](SceneFile& file, std::size_t i, const YamlNode& node) -> Remedy {
    if (node.kind != YamlNode::Kind::kScalar) return "write a file's name";
    if (node.text.find('\n') != std::string::npos || node.text.size() > 4096) return "write it on one line";
    return field(file, i) = node.text, std::nullopt;
  };
  key.get = [=](SceneFile& file, std::size_t i) -> Json { return field(file, i); };
  return key;
}

SceneKey scene_tuple(std::string path, std::string unit, std::vector<SceneField<double>> fields, std::size_t n_min,
                     SceneRange range, std::string meaning) {
  const std::size_t n = fields.size();
  const std::string count = n_min == n ? std::to_string(n) : fmt::format("{} to {}", n_min, n);
  SceneKey key = start(std::move(path), "list of numbers", std::move(unit),
                       fmt::format("{} numbers, each {}", count, text_of(range)), std::move(meaning));
  key.set = [=](SceneFile& file, std::size_t i, const YamlNode& node) -> Remedy {
    std::vector<double> values;
    if (auto remedy = read_numbers(node, range, values)) return remedy;
    if (values.size() < n_min || values.size() > n) return fmt::format("write a list of {} numbers", count);
    values.resize(n);
    for (std::size_t k = 0; k < n; ++k) fields[k](file, i) = values[k];
    return std::nullopt;
  };
  key.get = [=](SceneFile& file, std::size_t i) {
    std::vector<double> values;
    for (const auto& field : fields) values.push_back(field(file, i));
    return written_list(values, range.per_unit);
  };
  return key;
}

SceneKey scene_numbers(std::string path, std::string unit, SceneField<std::vector<double>> field, SceneRange range,
                       std::string meaning) {
  SceneKey key =
      start(std::move(path), "list of numbers", std::move(unit), "each " + text_of(range), std::move(meaning));
  key.set = [=](SceneFile& file, std::size_t i, const YamlNode& node) {
    return read_numbers(node, range, field(file, i));
  };
  key.get = [=](SceneFile& file, std::size_t i) { return written_list(field(file, i), range.per_unit); };
  return key;
}

SceneKey scene_rows(std::string path, std::string unit, SceneField<SceneStructure::Rows> field, std::string meaning) {
  const SceneRange any{-1e15, 1e15};
  SceneKey key =
      start(std::move(path), "rows of numbers", std::move(unit), "[[...], [...]], equally long", std::move(meaning));
  key.set = [=](SceneFile& file, std::size_t i, const YamlNode& node) -> Remedy {
    if (node.kind != YamlNode::Kind::kList || node.items.size() > kMostNumbers) {
      return fmt::format("write a list of at most {} rows: [[1, 0], [0, 1]]", kMostNumbers);
    }
    SceneStructure::Rows rows(node.items.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (auto remedy = read_numbers(node.items[k], any, rows[k])) return fmt::format("row {}: {}", k + 1, *remedy);
      if (rows[k].size() != rows[0].size()) return fmt::format("row {}: write {} numbers", k + 1, rows[0].size());
    }
    return field(file, i) = std::move(rows), std::nullopt;
  };
  key.get = [=](SceneFile& file, std::size_t i) {
    Json rows = Json::array();
    for (const auto& row : field(file, i)) rows.push_back(written_list(row, 1.0));
    return rows;
  };
  return key;
}

SceneKey scene_switch(std::string path, SceneField<bool> field, std::string meaning) {
  return scene_choice<bool>(std::move(path), std::move(field), {{"true", true}, {"false", false}}, std::move(meaning));
}

SceneKey scene_declared(std::string path, std::string unit, SceneField<Declared> field, SceneRange range,
                        std::string meaning) {
  SceneKey key = start(std::move(path), "true | false | number", std::move(unit), "true | false | " + text_of(range),
                       std::move(meaning));
  key.set = [=](SceneFile& file, std::size_t i, const YamlNode& node) -> Remedy {
    Declared& declared = field(file, i);
    const bool scalar = node.kind == YamlNode::Kind::kScalar;
    if (scalar && node.text == "true") return declared = {}, std::nullopt;
    if (scalar && node.text == "false") return declared = {Declared::Kind::kNothing, 0.0}, std::nullopt;
    double value = 0.0;
    if (auto remedy = read_number(node, range, value)) return "true = the truth, false = nothing; or " + *remedy;
    return declared = {Declared::Kind::kValue, value}, std::nullopt;
  };
  key.get = [=](SceneFile& file, std::size_t i) -> Json {
    const Declared& declared = field(file, i);
    if (declared.kind == Declared::Kind::kValue) return declared.value;
    return declared.kind == Declared::Kind::kTrue;
  };
  return key;
}

}  // namespace drivers
