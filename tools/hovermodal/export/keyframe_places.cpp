#include "tools/hovermodal/export/keyframe_places.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

#include "drivers/storage/csv_lines.h"
#include "drivers/storage/text_file.h"

namespace tools {

std::map<std::string, ImagePlace> keyframe_places(const std::string& tracks_path) {
  drivers::CsvLines lines(tracks_path);
  std::string_view line;
  std::vector<std::string_view> cells;
  do {
    if (!lines.next(line)) lines.fail("no header line with the names of the columns");
  } while (line.starts_with('#') || line.empty());
  drivers::split_cells(line, cells);
  const auto column = [&](std::string_view name) {
    const auto found = std::find(cells.begin(), cells.end(), name);
    if (found == cells.end()) lines.fail("no column `" + std::string(name) + "`; is this the tracks.csv of a run?");
    return static_cast<std::size_t>(found - cells.begin());
  };
  const std::size_t frame = column("frame"), region = column("region"), u = column("u_px"), v = column("v_px");
  const std::size_t n_cells = cells.size();

  struct Sum {
    double u = 0.0, v = 0.0;
    std::size_t n = 0;
  };
  std::map<std::string, Sum> sums;
  std::string first_frame;
  while (lines.next(line)) {
    drivers::split_cells(line, cells);
    if (cells.size() != n_cells) lines.fail("another number of cells than names; is the file cut off?");
    if (first_frame.empty()) first_frame = cells[frame];
    if (cells[frame] != first_frame) break;
    const auto u_px = drivers::parse_number(cells[u]), v_px = drivers::parse_number(cells[v]);
    if (!u_px || !v_px) lines.fail("u_px or v_px is no number");
    Sum& sum = sums[std::string(cells[region])];
    sum.u += *u_px, sum.v += *v_px, ++sum.n;
  }
  std::map<std::string, ImagePlace> out;
  for (const auto& [name, sum] : sums) {
    const auto n = static_cast<double>(sum.n);
    out[name] = {sum.u / n, sum.v / n};
  }
  return out;
}

}  // namespace tools
