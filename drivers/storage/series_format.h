#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace drivers {

// Format of the cells of a table of numbers.
struct CellFormat {
  char separator = ',';        // ',' ';' '\t', or ' ' for any run of white space
  bool decimal_comma = false;  // never together with ','
};

// Splits and trims; reuses `cells`. The views live as long as `line`.
void split_series_cells(std::string_view line, char separator, std::vector<std::string_view>& cells);

// "" and the usual words for a missing or infinite value (nan, NA, inf, -Infinity, ...).
[[nodiscard]] bool is_missing_cell(std::string_view cell) noexcept;

// A finite number; empty for anything else.
[[nodiscard]] std::optional<double> parse_series_number(std::string_view cell, bool decimal_comma);

// The format in which `line` consists of numbers and missing values, with at least one number; empty: none. Tried in
// turn: tab, semicolon, comma, white space; within each the decimal point before the decimal comma.
[[nodiscard]] std::optional<CellFormat> detect_cell_format(std::string_view line);

// The unit at the end of a column's name: "ax [m/s^2]", "ax (g)", "ax_m_s2"; empty = no known unit.
[[nodiscard]] std::string unit_of_name(std::string_view name);

// "ax [m/s^2]" -> "ax"; a name without a known unit in brackets is unchanged.
[[nodiscard]] std::string_view without_unit(std::string_view name);

// A unit of length, velocity or acceleration.
struct MotionUnit {
  int n_integrations = 0;  // to a displacement: 0 length, 1 velocity, 2 acceleration
  double to_si = 0.0;      // m, m/s, m/s^2 per unit; 0 = not a length (px)
};
[[nodiscard]] std::optional<MotionUnit> motion_unit(std::string_view unit);

}  // namespace drivers
