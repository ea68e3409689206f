#include "drivers/storage/motors_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <string_view>
#include <utility>

#include "drivers/storage/csv_lines.h"
#include "drivers/storage/limits.h"
#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

using Cells = std::vector<std::string_view>;

constexpr int kMostMotors = 64;

std::size_t column(const CsvLines& lines, const Cells& names, std::string_view name) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) {
    lines.fail(fmt::format("no column {}: name the columns t_s, motor, hz (there are: {})", name,
                           printable(fmt::format("{}", fmt::join(names, ", ")))));
  }
  return static_cast<std::size_t>(at - names.begin());
}

double number_at(const CsvLines& lines, const Cells& cells, std::size_t place, const char* name, double least,
                 double most) {
  if (place >= cells.size()) lines.fail(fmt::format("column {} ({}) is missing", place + 1, name));
  const auto number = parse_number(cells[place]);
  if (!number || !(*number >= least && *number <= most)) {
    lines.fail(fmt::format("column {} ({}): \"{}\" is no number from {:g} to {:g}", place + 1, name,
                           printable(cells[place]), least, most));
  }
  return *number;
}

}  // namespace

std::vector<core::MotorRate> read_motors_csv(const std::string& path) {
  CsvLines lines(path);
  lines.require_lines(Limits::kAttitudes, "give those of the flight only");
  std::string_view line;
  Cells cells;
  std::array<std::size_t, 2> places{};
  bool has_names = false;
  std::map<int, std::vector<double>> turns;
  while (lines.next(line)) {
    if (line.empty() || line.front() == '#') continue;
    split_cells(line, cells);
    if (!has_names) {
      places = {column(lines, cells, "motor"), column(lines, cells, "hz")};
      has_names = true;
      continue;
    }
    const double motor = number_at(lines, cells, places[0], "motor", 1.0, kMostMotors);
    const double hz = number_at(lines, cells, places[1], "hz", 0.0, core::kMostTurns_hz);
    if (hz >= core::kLeastTurns_hz) turns[static_cast<int>(motor)].push_back(hz);
  }
  if (turns.empty()) lines.fail("no motor turns at 1 Hz or more");
  std::vector<core::MotorRate> out;
  for (auto& [motor, hz] : turns) out.push_back(core::motor_rate(motor, std::move(hz)));
  return out;
}

}  // namespace drivers
