#include "drivers/storage/series_format.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/types/constants.h"
#include "drivers/storage/ascii.h"
#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

constexpr std::string_view kBlank = " \t\r";

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

bool all_numbers(const std::vector<std::string_view>& cells, bool decimal_comma) {
  std::size_t n_numbers = 0;
  for (const std::string_view cell : cells) {
    if (is_missing_cell(cell)) continue;
    if (!parse_series_number(cell, decimal_comma)) return false;
    ++n_numbers;
  }
  return n_numbers > 0;
}

// Position of the opening bracket of a known unit at the end of a trimmed name; npos = none.
std::size_t unit_bracket(std::string_view name) {
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    const std::size_t begin = name.rfind(open);
    if (begin == std::string_view::npos || !name.ends_with(close)) continue;
    if (motion_unit(name.substr(begin + 1, name.size() - begin - 2))) return begin;
  }
  return std::string_view::npos;
}

struct NamedUnit {
  std::string_view name;
  MotionUnit unit;
};
constexpr std::array kLengths{
    NamedUnit{"m", {0, 1.0}},   NamedUnit{"cm", {0, 1e-2}}, NamedUnit{"mm", {0, 1e-3}},
    NamedUnit{"um", {0, 1e-6}}, NamedUnit{"nm", {0, 1e-9}}, NamedUnit{"in", {0, 0.0254}},
};
constexpr std::array kOthers{
    NamedUnit{"px", {0, 0.0}},
    NamedUnit{"pixel", {0, 0.0}},
    NamedUnit{"g", {2, core::kStandardGravity_m_s2}},
    NamedUnit{"mg", {2, 1e-3 * core::kStandardGravity_m_s2}},
    NamedUnit{"gal", {2, 1e-2}},
};

}  // namespace

void split_series_cells(std::string_view line, char separator, std::vector<std::string_view>& cells) {
  cells.clear();
  if (separator == ' ') {
    for (std::size_t at = line.find_first_not_of(kBlank); at != std::string_view::npos;) {
      const std::size_t end = std::min(line.find_first_of(kBlank, at), line.size());
      cells.push_back(line.substr(at, end - at));
      at = line.find_first_not_of(kBlank, end);
    }
    return;
  }
  for (;;) {
    const std::size_t end = line.find(separator);
    cells.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

bool is_missing_cell(std::string_view cell) noexcept {
  if (cell.starts_with('-') || cell.starts_with('+')) cell.remove_prefix(1);
  constexpr std::array<std::string_view, 12> kWords{"",    "nan", "NaN", "NAN",      "na",       "NA",
                                                    "inf", "Inf", "INF", "infinity", "Infinity", "null"};
  return std::find(kWords.begin(), kWords.end(), cell) != kWords.end();
}

std::optional<double> parse_series_number(std::string_view cell, bool decimal_comma) {
  if (!decimal_comma) return parse_number(cell);
  if (cell.find('.') != std::string_view::npos) return std::nullopt;
  std::string with_point(cell);
  const std::size_t comma = with_point.find(',');
  if (comma != std::string::npos) with_point[comma] = '.';
  return parse_number(with_point);
}

std::optional<CellFormat> detect_cell_format(std::string_view line) {
  std::vector<std::string_view> cells;
  for (const char separator : {'\t', ';', ',', ' '}) {
    if (separator != ' ' && line.find(separator) == std::string_view::npos) continue;
    split_series_cells(line, separator, cells);
    if (all_numbers(cells, false)) return CellFormat{separator, false};
    if (separator != ',' && all_numbers(cells, true)) return CellFormat{separator, true};
  }
  return std::nullopt;
}

std::string unit_of_name(std::string_view name) {
  if (const auto bracket = unit_bracket(name); bracket != std::string_view::npos)
    return std::string(trimmed(name.substr(bracket + 1, name.size() - bracket - 2)));
  // The longest ending of up to three parts: for ax_m_s2 it is m/s2, not s2.
  std::size_t at = name.size();
  std::string found;
  for (int k = 0; k < 3 && at != std::string_view::npos && at > 0; ++k) {
    at = name.rfind('_', at - 1);
    if (at == std::string_view::npos) break;
    std::string unit(name.substr(at + 1));
    std::replace(unit.begin(), unit.end(), '_', '/');
    if (motion_unit(unit)) found = unit;
  }
  return found;
}

std::string_view without_unit(std::string_view name) {
  const std::size_t bracket = unit_bracket(name);
  const std::string_view bare = bracket == std::string_view::npos ? name : trimmed(name.substr(0, bracket));
  return bare.empty() ? name : bare;
}

std::optional<MotionUnit> motion_unit(std::string_view unit) {
  std::string name = lower_ascii(trimmed(unit));
  replace_all(name, "\xC2\xB5", "u");  // micro sign
  replace_all(name, "\xCE\xBC", "u");  // Greek mu
  replace_all(name, "\xC2\xB2", "2");  // superscript two
  replace_all(name, "^", "");
  replace_all(name, "**", "");
  replace_all(name, "/sec", "/s");
  replace_all(name, " ", "");
  for (const NamedUnit& other : kOthers) {
    if (name == other.name) return other.unit;
  }
  for (const NamedUnit& length : kLengths) {
    if (!name.starts_with(length.name)) continue;
    const std::string_view rest = std::string_view(name).substr(length.name.size());
    if (rest.empty()) return length.unit;
    if (rest == "/s") return MotionUnit{1, length.unit.to_si};
    if (rest == "/s2" || rest == "/s/s") return MotionUnit{2, length.unit.to_si};
  }
  return std::nullopt;
}

}  // namespace drivers
