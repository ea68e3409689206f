#include "drivers/storage/attitude_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>

#include "drivers/storage/csv_lines.h"
#include "drivers/storage/limits.h"
#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

using Cells = std::vector<std::string_view>;

struct Column {
  std::string name;
  std::size_t place = 0;
  double factor = 1.0;  // to s, rad
};
struct Layout {
  Column time;
  std::vector<Column> attitude;  // three angles or four numbers
};

std::optional<Column> find(const Cells& names, const std::string& name, double factor) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) return std::nullopt;
  return Column{name, static_cast<std::size_t>(at - names.begin()), factor};
}

std::optional<std::vector<Column>> find_all(const Cells& names, const std::vector<std::string>& wanted, double factor) {
  std::vector<Column> found;
  for (const std::string& name : wanted) {
    if (const auto column = find(names, name, factor)) found.push_back(*column);
  }
  if (found.size() != wanted.size()) return std::nullopt;
  return found;
}

Layout read_header(CsvLines& lines, const Cells& names) {
  Layout layout;
  const std::array<std::pair<const char*, double>, 4> times{
      {{"t_s", 1.0}, {"t_ms", 1e-3}, {"t_us", 1e-6}, {"t_ns", 1e-9}}};
  bool timed = false;
  for (const auto& [name, factor] : times) {
    if (const auto column = find(names, name, factor); column && !timed) layout.time = *column, timed = true;
  }
  if (!timed)
    lines.fail(fmt::format("no column of times; name it t_s, t_ms, t_us or t_ns (there are: {})",
                           printable(fmt::format("{}", fmt::join(names, ", ")))));
  auto attitude = find_all(names, {"qw", "qx", "qy", "qz"}, 1.0);
  if (!attitude) attitude = find_all(names, {"roll_deg", "pitch_deg", "yaw_deg"}, std::numbers::pi / 180.0);
  if (!attitude) attitude = find_all(names, {"roll_rad", "pitch_rad", "yaw_rad"}, 1.0);
  if (!attitude)
    lines.fail(
        fmt::format("no attitude; name its columns roll_deg, pitch_deg, yaw_deg, or ..._rad, or qw, qx, qy, qz "
                    "(there are: {})",
                    printable(fmt::format("{}", fmt::join(names, ", ")))));
  layout.attitude = std::move(*attitude);
  return layout;
}

double number_at(const CsvLines& lines, const Cells& cells, const Column& column) {
  if (column.place >= cells.size())
    lines.fail(
        fmt::format("column {} ({}) is missing: the line has {} cells", column.place + 1, column.name, cells.size()));
  const auto number = parse_number(cells[column.place]);
  if (!number || std::abs(*number) > 1e18)
    lines.fail(fmt::format("column {} ({}): \"{}\" is no number", column.place + 1, column.name,
                           printable(cells[column.place])));
  return *number * column.factor;
}

core::AttitudeSample read_row(const CsvLines& lines, const Cells& cells, const Layout& layout) {
  core::AttitudeSample sample;
  sample.t_s = number_at(lines, cells, layout.time);
  std::array<double, 4> v{};
  for (std::size_t i = 0; i < layout.attitude.size(); ++i) v[i] = number_at(lines, cells, layout.attitude[i]);
  if (layout.attitude.size() == 4) {
    if (!(std::hypot(std::hypot(v[0], v[1]), std::hypot(v[2], v[3])) > 1e-3))
      lines.fail(fmt::format("column {} (qw) and those beside: a quaternion without length is no attitude",
                             layout.attitude[0].place + 1));
    sample.wxyz = v;
  } else {
    sample.wxyz = core::attitude_of(v[0], v[1], v[2]);
  }
  return sample;
}

}  // namespace

std::vector<core::AttitudeSample> read_attitude_csv(const std::string& path) {
  CsvLines lines(path);
  lines.require_lines(Limits::kAttitudes, "give those of the flight only");
  std::string_view line;
  Cells cells;
  std::optional<Layout> layout;
  std::vector<core::AttitudeSample> samples;
  while (lines.next(line)) {
    if (line.empty() || line.front() == '#') continue;
    split_cells(line, cells);
    if (!layout) {
      layout = read_header(lines, cells);
      continue;
    }
    samples.push_back(read_row(lines, cells, *layout));
    if (samples.size() > 1 && !(samples.back().t_s > samples[samples.size() - 2].t_s))
      lines.fail(
          fmt::format("column {} ({}): time {:.9g} s does not go on from {:.9g} s; sort the rows, remove repeated ones",
                      layout->time.place + 1, layout->time.name, samples.back().t_s, samples[samples.size() - 2].t_s));
  }
  if (samples.size() < 2) lines.fail("fewer than two attitudes");
  return samples;
}

}  // namespace drivers
