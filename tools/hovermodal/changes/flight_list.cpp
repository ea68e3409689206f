#include "tools/hovermodal/changes/flight_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>

#include "drivers/storage/csv_lines.h"
#include "drivers/storage/limits.h"
#include "drivers/storage/text_file.h"
#include "tools/hovermodal/batch/flight_order.h"

namespace tools {
namespace {

namespace fs = std::filesystem;
using Cells = std::vector<std::string_view>;

struct FlightColumns {
  std::size_t report = 0, time = 0;
  bool is_date = false;
  std::optional<std::size_t> temperature;
};

std::optional<std::size_t> place_of(const Cells& names, std::string_view name) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) return std::nullopt;
  return static_cast<std::size_t>(at - names.begin());
}

FlightColumns columns_of(const drivers::CsvLines& lines, const Cells& names) {
  const auto report = place_of(names, "report"), date = place_of(names, "date"), day = place_of(names, "day");
  if (!report || (!date && !day)) {
    lines.fail(
        fmt::format("the columns report and date (or day) are needed, temperature_c is used if it is there "
                    "(there are: {})",
                    drivers::printable(fmt::format("{}", fmt::join(names, ", ")))));
  }
  return {*report, date ? *date : *day, date.has_value(), place_of(names, "temperature_c")};
}

// Days from 1970 of YYYY-MM-DD, with THH:MM or a space in place of the T.
std::optional<double> days_of_date(std::string_view text) {
  const auto number = [&](std::size_t at, std::size_t n) -> int {
    if (text.size() < at + n) return -1;
    const auto value = drivers::parse_unsigned(text.substr(at, n));
    return value ? static_cast<int>(*value) : -1;
  };
  if (text.size() < 10 || text[4] != '-' || text[7] != '-') return std::nullopt;
  const int year = number(0, 4), month = number(5, 2), day = number(8, 2);
  if (year < 0 || month < 0 || day < 0) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) return std::nullopt;
  const auto days = static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
  if (text.size() == 10) return days;
  const int hour = number(11, 2), minute = number(14, 2);
  const bool is_time = text.size() == 16 && (text[10] == 'T' || text[10] == ' ') && text[13] == ':';
  if (!is_time || hour < 0 || hour > 23 || minute < 0 || minute > 59) return std::nullopt;
  return days + (hour * 60.0 + minute) / 1440.0;
}

std::string_view cell_at(const drivers::CsvLines& lines, const Cells& cells, std::size_t place, const char* name) {
  if (place >= cells.size())
    lines.fail(fmt::format("column {} ({}) is missing: the line has {} cells", place + 1, name, cells.size()));
  return cells[place];
}

double number_at(const drivers::CsvLines& lines, std::string_view cell, const char* name) {
  const auto number = drivers::parse_number(cell);
  if (!number) lines.fail(fmt::format("{}: \"{}\" is no number", name, drivers::printable(cell)));
  return *number;
}

DatedFlight flight_of(const drivers::CsvLines& lines, const Cells& cells, const FlightColumns& columns) {
  DatedFlight flight;
  flight.name = std::string(cell_at(lines, cells, columns.report, "report"));
  if (flight.name.empty()) lines.fail("report: no file is named");
  const std::string_view time = cell_at(lines, cells, columns.time, columns.is_date ? "date" : "day");
  if (columns.is_date) {
    const auto days = days_of_date(time);
    if (!days) {
      lines.fail(
          fmt::format("date: \"{}\" is no date; write 2026-03-31 or 2026-03-31T14:05", drivers::printable(time)));
    }
    flight.date = std::string(time), flight.day = *days;
  } else {
    flight.day = number_at(lines, time, "day");
  }
  if (!columns.temperature) return flight;
  const std::string_view warm = cell_at(lines, cells, *columns.temperature, "temperature_c");
  if (!warm.empty()) flight.temperature_c = number_at(lines, warm, "temperature_c");
  return flight;
}

std::vector<DatedFlight> read_table(const std::string& path) {
  drivers::CsvLines lines(path);
  lines.require_lines(drivers::Limits::kFlights, "give the table of one structure");
  std::string_view line;
  Cells cells;
  std::optional<FlightColumns> columns;
  std::vector<DatedFlight> flights;
  while (lines.next(line)) {
    if (line.empty() || line.front() == '#') continue;
    drivers::split_cells(line, cells);
    if (columns) {
      flights.push_back(flight_of(lines, cells, *columns));
    } else {
      columns = columns_of(lines, cells);
    }
  }
  if (flights.size() < 2) lines.fail("fewer than two flights");
  return flights;
}

std::vector<DatedFlight> list_folder(const std::string& path) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
    if (fs::is_regular_file(entry.path() / kModesFile)) names.push_back(entry.path().filename().string());
    if (names.size() > drivers::Limits::kFlights) {
      throw drivers::FileError(fmt::format("{}: more than {} flights; give the folder of one structure",
                                           drivers::printable(path, 500), drivers::Limits::kFlights));
    }
  }
  if (names.size() < 2) {
    throw drivers::FileError(
        drivers::printable(path, 500) +
        ": fewer than two folders with a modal.json; hovermodal changes --help states what is read");
  }
  std::sort(names.begin(), names.end());
  std::vector<DatedFlight> flights;
  for (const std::string& name : names) {
    DatedFlight& flight = flights.emplace_back();
    flight.name = name, flight.day = static_cast<double>(flights.size());
  }
  return flights;
}

}  // namespace

std::vector<DatedFlight> read_flights(const std::string& path) {
  const bool is_folder = fs::is_directory(path);
  std::vector<DatedFlight> flights = is_folder ? list_folder(path) : read_table(path);
  const fs::path beside = is_folder ? fs::path(path) : fs::path(path).parent_path();
  for (DatedFlight& flight : flights) {
    const fs::path named = beside / flight.name;
    flight.report = app::read_modal_json((fs::is_directory(named) ? named / kModesFile : named).string());
    flight.report.estimate.poles.clear();
  }
  std::stable_sort(flights.begin(), flights.end(),
                   [](const DatedFlight& a, const DatedFlight& b) { return a.day < b.day; });
  return flights;
}

}  // namespace tools
