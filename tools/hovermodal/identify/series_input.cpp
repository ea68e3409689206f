#include "tools/hovermodal/identify/series_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <stdexcept>

#include "drivers/exchange/series_file.h"
#include "drivers/storage/series_format.h"
#include "drivers/storage/text_file.h"
#include "tools/hovermodal/identify/sample_grid.h"

namespace tools {

namespace {

using drivers::SeriesFile;

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

std::string joined_names(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return drivers::printable(text, 200);
}

std::size_t column_index(const SeriesFile& file, const std::string& wanted, const std::string& path) {
  if (const int named = file.column(wanted); named >= 0) return static_cast<std::size_t>(named);
  const auto number = drivers::parse_unsigned(wanted);
  if (number && *number >= 1 && *number <= file.names.size()) return static_cast<std::size_t>(*number - 1);
  refuse(fmt::format("{}: no column '{}'; there are 1 .. {}: {}", path, wanted, file.names.size(),
                     joined_names(file.names)));
}

bool is_no_channel(const SeriesFile& file, std::size_t column) {
  const std::string& name = file.names[column];
  if (name == "frame" || name == "scale_mm_per_px") return true;
  if (static_cast<int>(column) == time_column(file)) return true;
  // LabVIEW's column of times, empty where it has none.
  return name == "X_Value";
}

std::vector<std::size_t> chosen_columns(const SeriesFile& file, const SeriesRequest& request, const std::string& path) {
  std::vector<std::size_t> chosen;
  const auto add = [&](std::size_t column) {
    if (std::find(chosen.begin(), chosen.end(), column) == chosen.end()) chosen.push_back(column);
  };
  for (const std::string& wanted : request.channels) add(column_index(file, wanted, path));
  if (request.channels.empty()) {
    for (std::size_t c = 0; c < file.names.size(); ++c) {
      if (!is_no_channel(file, c)) add(c);
    }
  }
  if (chosen.empty()) refuse(path + ": no column but times");
  if (!request.input.empty()) add(column_index(file, request.input, path));
  for (const std::string& base : request.bases) add(column_index(file, base, path));
  return chosen;
}

int integrations_of(const std::string& quantity) {
  if (quantity == "d") return 0;
  if (quantity == "v") return 1;
  if (quantity == "a") return 2;
  refuse(fmt::format("--quantity {}: allowed d (displacement), v (velocity), a (acceleration)", quantity));
}

// Places the file's rows on the grid, values multiplied by `unit_factor`.
std::vector<double> on_grid(const std::vector<double>& column, const SampleGrid& grid, double unit_factor) {
  std::vector<double> values(grid.n_cells, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t row = 0; row < column.size(); ++row) {
    if (grid.cell_of_row[row] >= 0) values[static_cast<std::size_t>(grid.cell_of_row[row])] = column[row] * unit_factor;
  }
  return values;
}

class SeriesLoader {
 public:
  SeriesLoader(const SeriesFile& file, const SeriesRequest& request, const std::string& path)
      : file_(file), request_(request), path_(path), columns_(chosen_columns(file, request, path)) {}

  [[nodiscard]] LoadedSeries load() {
    const SampleGrid grid = sample_grid(file_, request_.rate_hz, path_);
    out_.remarks.insert(out_.remarks.end(), grid.remarks.begin(), grid.remarks.end());
    out_.series.rate_hz = grid.rate_hz;
    const int times = time_column(file_);
    if (times >= 0 && !file_.columns[static_cast<std::size_t>(times)].empty()) {
      const double first_s = file_.columns[static_cast<std::size_t>(times)].front();
      if (std::isfinite(first_s)) out_.first_s = first_s;
    }
    check_counts();
    choose_units();
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const std::size_t column = columns_[i];
      core::ChannelInfo channel;
      channel.region = static_cast<std::uint16_t>(i);
      channel.name = file_.names[column];
      channel.row_delay_s = delay_s(i);
      channel.is_base = is_base(column);
      channel.n_integrations = integrations(i);
      out_.series.channels.push_back(channel);
      out_.columns.push_back(column + 1);
      out_.series.value.push_back(on_grid(file_.columns[column], grid, factors_[i]));
    }
    remark_on_quantities();
    return std::move(out_);
  }

 private:
  void check_counts() const {
    const std::size_t n = columns_.size();
    if (request_.quantities.size() > 1 && request_.quantities.size() != n) {
      refuse(fmt::format("--quantity names {} quantities for {} channels of {}; give one, or one for each",
                         request_.quantities.size(), n, path_));
    }
    if (request_.delays_ms.size() > 1 && request_.delays_ms.size() != n)
      refuse(fmt::format("--delays-ms names {} delays for {} channels of {}", request_.delays_ms.size(), n, path_));
  }

  [[nodiscard]] std::string unit(std::size_t i) const {
    const std::string& own = file_.units[columns_[i]];
    const auto comment = file_.comments.find("unit");
    return own.empty() && comment != file_.comments.end() ? comment->second : own;
  }

  // Different units are converted to metres and seconds, so that shapes of mixed channels are displacements of one
  // scale.
  void choose_units() {
    factors_.assign(columns_.size(), 1.0);
    out_.series.unit = unit(0).empty() ? "units" : unit(0);
    bool alike = true;
    for (std::size_t i = 1; i < columns_.size(); ++i) alike = alike && unit(i) == unit(0);
    if (alike) return;
    out_.series.unit = "SI units";
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const auto motion = drivers::motion_unit(unit(i));
      if (motion && motion->to_si > 0.0) {
        factors_[i] = motion->to_si;
      } else {
        out_.remarks.push_back(
            fmt::format("{}: its unit '{}' has no scale beside the others'; the shape's row has none either",
                        file_.names[columns_[i]], unit(i)));
      }
    }
  }

  [[nodiscard]] int integrations(std::size_t i) {
    const auto& said = request_.quantities;
    if (!said.empty()) return integrations_of(said.size() == 1 ? said.front() : said[i]);
    const auto motion = drivers::motion_unit(unit(i));
    if (!motion) unknown_.push_back(file_.names[columns_[i]]);
    return motion ? motion->n_integrations : 0;
  }

  void remark_on_quantities() {
    if (!unknown_.empty()) {
      out_.remarks.push_back("no unit known of " + joined_names(unknown_) +
                             ": assumed to be displacements; set --quantity a for accelerations, v for velocities");
    }
    if (file_.n_not_finite > 0)
      out_.remarks.push_back(fmt::format("{} infinite values are treated as missing", file_.n_not_finite));
    if (!file_.has_names) out_.remarks.push_back("the file has no line of names: its columns are c1, c2, ...");
  }

  [[nodiscard]] bool is_base(std::size_t column) const {
    if (!request_.input.empty() && column_index(file_, request_.input, path_) == column) return true;
    return std::any_of(request_.bases.begin(), request_.bases.end(),
                       [&](const std::string& base) { return column_index(file_, base, path_) == column; });
  }

  // The displacements.csv of a run states how long after the time stamp each channel is seen.
  [[nodiscard]] double delay_s(std::size_t i) const {
    if (!request_.delays_ms.empty())
      return 1e-3 * (request_.delays_ms.size() == 1 ? request_.delays_ms.front() : request_.delays_ms[i]);
    const auto said = file_.comments.find("row_delay_s." + file_.names[columns_[i]]);
    return said == file_.comments.end() ? 0.0 : drivers::parse_number(said->second).value_or(0.0);
  }

  const SeriesFile& file_;
  const SeriesRequest& request_;
  const std::string& path_;
  std::vector<std::size_t> columns_;
  std::vector<double> factors_;
  std::vector<std::string> unknown_;
  LoadedSeries out_;
};

}  // namespace

LoadedSeries load_series(const std::string& path, const SeriesRequest& request) {
  drivers::ForeignFormat format;
  format.no_names = request.no_header;
  if (!request.is_quiet)
    format.progress = [&](std::uint64_t n_lines) { fmt::print(stderr, "{}: {} lines read\n", path, n_lines); };
  const SeriesFile file = drivers::read_any_series(path, format);
  return SeriesLoader(file, request, path).load();
}

int channel_index(const LoadedSeries& loaded, const std::string& wanted, const std::string& path) {
  const std::vector<core::ChannelInfo>& channels = loaded.series.channels;
  std::vector<std::string> names;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c].name == wanted) return static_cast<int>(c);
    names.push_back(channels[c].name);
  }
  const auto number = drivers::parse_unsigned(wanted);
  for (std::size_t c = 0; number && c < channels.size(); ++c) {
    if (loaded.columns[c] == *number) return static_cast<int>(c);
  }
  refuse(fmt::format("{}: '{}' is none of the channels {}", path, wanted, joined_names(names)));
}

}  // namespace tools
