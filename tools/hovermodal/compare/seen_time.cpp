#include "tools/hovermodal/compare/seen_time.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <string_view>
#include <vector>

#include "core/geometry/channel_layout.h"
#include "drivers/storage/csv_lines.h"
#include "drivers/storage/text_file.h"

namespace tools {
namespace {

// What the head of a tracks.csv says about the readout.
struct ReadoutHead {
  double exposure_s = 0.0, readout_s = 0.0, width_px = 0.0, height_px = 0.0;
  bool along_u = false;

  void note(const std::string& key, const std::string& value) {
    const double number = drivers::parse_number(value).value_or(0.0);
    if (key == "exposure_ms") exposure_s = 1e-3 * number;
    if (key == "readout_ms") readout_s = 1e-3 * number;
    if (key == "readout_direction") {
      along_u = value == "left" || value == "right";
      sign_ = value == "up" || value == "left" ? -1.0 : 1.0;
    }
    const std::size_t times = value.find(" x ");
    if (key != "image_size_px" || times == std::string::npos) return;
    width_px = drivers::parse_number(std::string_view(value).substr(0, times)).value_or(0.0);
    height_px = drivers::parse_number(std::string_view(value).substr(times + 3)).value_or(0.0);
  }
  [[nodiscard]] double s_per_px() const {
    const double size_px = along_u ? width_px : height_px;
    return size_px > 0.0 ? sign_ * readout_s / size_px : 0.0;
  }

 private:
  double sign_ = 1.0;
};

}  // namespace

SeenTime seen_time(const std::string& run, const std::string& channel) {
  const std::filesystem::path path = std::filesystem::path(run) / "tracks.csv";
  if (!std::filesystem::is_directory(run) || !std::filesystem::exists(path)) return {};
  drivers::CsvLines lines(path.string());
  ReadoutHead head;
  std::string_view line;
  std::string key, value;
  std::vector<std::string_view> cells;
  while (lines.next(line) && line.starts_with('#')) {
    if (drivers::split_comment(line, key, value)) head.note(key, value);
  }
  drivers::split_cells(line, cells);
  const std::size_t n_cells = cells.size();
  const auto column = [&](std::string_view name) {
    return static_cast<std::size_t>(std::find(cells.begin(), cells.end(), name) - cells.begin());
  };
  const std::size_t point = column("point"), region = column("region"), place = column(head.along_u ? "u_px" : "v_px");
  SeenTime out;
  out.half_exposure_s = 0.5 * head.exposure_s;
  if (std::max({point, region, place}) >= n_cells || head.s_per_px() == 0.0) return out;

  const std::string_view stem = core::without_axis(channel);
  std::map<std::string, double, std::less<>> first_px;
  double sum_px = 0.0, n = 0.0;
  while (lines.next(line)) {
    drivers::split_cells(line, cells);
    if (cells.size() != n_cells) lines.fail("another number of cells than names; is the file cut off?");
    if (cells[region] != channel && cells[region] != stem) continue;
    const auto px = drivers::parse_number(cells[place]);
    if (!px) lines.fail("a place is no number");
    sum_px += *px - first_px.try_emplace(std::string(cells[point]), *px).first->second;
    n += 1.0;
  }
  if (n > 0.0) out.mean_row_shift_s = head.s_per_px() * sum_px / n;
  return out;
}

}  // namespace tools
