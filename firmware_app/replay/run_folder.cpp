#include "firmware_app/replay/run_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "core/closure/response/channel_retime.h"
#include "core/geometry/channel_displacement.h"
#include "core/types/constants.h"
#include "drivers/storage/csv.h"
#include "drivers/storage/series_format.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/chain/displacement_meter.h"
#include "firmware_app/config/calibration.h"
#include "firmware_app/config/structure_scale.h"
#include "firmware_app/replay/point_places.h"
#include "firmware_app/replay/tracks_axes.h"
#include "firmware_app/report/modal_json.h"

namespace app {
namespace {

using core::kNan;

FrameTimes timed(std::vector<std::uint64_t> number, std::vector<double> t_s, double rate_hz) {
  FrameTimes out{std::move(number), std::move(t_s)};
  if (out.number.size() < 2 || !(rate_hz > 0.0)) return out;
  const auto n_numbers = static_cast<std::size_t>(out.number.back() - out.number.front()) + 1;
  out.n_missing = n_numbers > out.number.size() ? n_numbers - out.number.size() : 0;
  // Deviations from a grid of that rate, whose offset is their mean.
  double sum = 0.0, squares = 0.0;
  const auto n = static_cast<double>(out.number.size());
  const auto off = [&](std::size_t k) {
    return out.t_s[k] - out.t_s[0] - static_cast<double>(out.number[k] - out.number[0]) / rate_hz;
  };
  for (std::size_t k = 0; k < out.number.size(); ++k) sum += off(k);
  for (std::size_t k = 0; k < out.number.size(); ++k) squares += std::pow(off(k) - sum / n, 2);
  out.jitter_rms_s = std::sqrt(squares / n);
  return out;
}

std::size_t n_cells(std::uint64_t first, std::uint64_t last, const std::string& path) {
  if (last < first || last - first >= kMostRecordFrames)
    throw drivers::FileError(path + ": frame numbers extend over more than a million frames, or go back");
  return static_cast<std::size_t>(last - first) + 1;
}

}  // namespace

core::CameraInfo camera_of_tracks(const drivers::TracksFile& file, const AppConfig& config) {
  core::CameraInfo camera = file.camera;
  if (config.camera.rate_hz > 0.0) camera.rate_hz = config.camera.rate_hz;
  // Present declarations of the operator override those in the file.
  if (config.camera.readout_ms != 0.0) {
    camera.readout_ns = static_cast<std::int64_t>(std::llround(config.camera.readout_ms * 1e6));
    camera.readout_direction = config.camera.readout_direction;
  }
  if (!(camera.rate_hz > 0.0)) throw std::invalid_argument("the tracks do not say their rate: set camera.rate_hz");
  return camera;
}

MeasuredRows rows_of_tracks(const AppConfig& declared, const drivers::TracksFile& file,
                            const CorrectionSet& corrections) {
  const AppConfig config = with_axes_of(file, declared);
  const core::CameraInfo camera = camera_of_tracks(file, config);
  const PointPlaces places(file, config);
  const std::unique_ptr<Geometry> geometry = make_geometry(config, camera, places.first(), corrections);
  DisplacementMeter meter(geometry->displacement, geometry->readout);
  MeasuredRows out;
  out.series.rate_hz = camera.rate_hz;
  out.series.channels = geometry->displacement.channels();
  out.series.unit = structure_scale(config, camera_model(config, camera)).known ? "mm" : "px";
  out.series.value.resize(out.series.channels.size());
  core::DisplacementSample sample = geometry->displacement.sample_prototype();
  core::TrackFrame points;
  std::vector<std::uint64_t> number;
  std::vector<double> t_s;
  drivers::TracksPass frames(file);
  for (core::TrackFrame frame; frames.next(frame);) {
    places.spread(frame, points);
    (void)meter.begin_frame(points.sequence);
    meter.measure(points, 1, sample);
    number.push_back(frame.sequence);
    t_s.push_back(1e-9 * static_cast<double>(frame.t_start_ns - file.first.t_start_ns));
    for (std::size_t c = 0; c < out.series.value.size(); ++c)
      out.series.value[c].push_back(sample.seen[c] != 0 ? sample.value_mm[c] : kNan);
  }
  out.times = timed(std::move(number), std::move(t_s), camera.rate_hz);
  return out;
}

MeasuredRows rows_of_displacements(const std::string& path, const std::vector<std::string>& bases) {
  drivers::SeriesFile file = drivers::read_series_csv(path);
  const int frame = file.column("frame"), time = file.column("t_s");
  const auto comment = [&](const std::string& key) {
    const auto found = file.comments.find(key);
    return found == file.comments.end() ? std::string() : found->second;
  };
  MeasuredRows out;
  out.series.rate_hz = drivers::parse_number(comment("rate_hz")).value_or(0.0);
  out.series.unit = comment("unit");
  if (frame < 0 || time < 0 || !(out.series.rate_hz > 0.0) || file.columns.front().empty()) {
    throw drivers::FileError(path +
                             ": is no displacements.csv of a run: columns frame and t_s and a comment rate_hz "
                             "are needed");
  }
  std::vector<std::uint64_t> number;
  for (const double one : file.columns[static_cast<std::size_t>(frame)]) {
    if (!(one >= 0.0 && one < 1e15 && one == std::floor(one)))
      throw drivers::FileError(fmt::format("{}: frame: {:.12g} is no number of a frame (0, 1, 2 ...)", path, one));
    number.push_back(static_cast<std::uint64_t>(one));
  }
  out.times = timed(std::move(number), file.columns[static_cast<std::size_t>(time)], out.series.rate_hz);
  for (std::size_t c = 0; c < file.names.size(); ++c) {
    const std::string& name = file.names[c];
    if (name == "scale_mm_per_px") out.scale_mm_per_px = std::move(file.columns[c]);
    if (name == "frame" || name == "t_s" || name == "scale_mm_per_px") continue;
    core::ChannelInfo channel;
    channel.name = name;
    channel.region = static_cast<std::uint16_t>(out.series.channels.size());
    channel.row_delay_s = drivers::parse_number(comment("row_delay_s." + name)).value_or(0.0);
    channel.is_base = std::find(bases.begin(), bases.end(), name) != bases.end();
    out.series.channels.push_back(channel);
    out.series.value.push_back(std::move(file.columns[c]));
  }
  return out;
}

void keep_last(std::size_t n, MeasuredRows& rows) {
  const std::size_t n_before = rows.times.number.size();
  if (n_before <= n) return;
  const auto cut = [&](auto& values) {
    if (values.size() == n_before) values.erase(values.begin(), values.end() - static_cast<std::ptrdiff_t>(n));
  };
  for (auto& channel : rows.series.value) cut(channel);
  cut(rows.scale_mm_per_px);
  cut(rows.times.t_s);
  cut(rows.times.number);
  rows.times = timed(std::move(rows.times.number), std::move(rows.times.t_s), rows.series.rate_hz);
}

ChannelSeries on_grid(const MeasuredRows& rows) {
  ChannelSeries out = rows.series;
  const auto n = static_cast<Eigen::Index>(rows.times.number.size());
  if (rows.times.are_measured() && rows.times.are_uneven(out.rate_hz) && n > 1) {
    core::closure::ChannelRecord record;
    record.rate_hz = out.rate_hz;
    record.value.resize(n, static_cast<Eigen::Index>(out.value.size()));
    record.input.resize(n, 0);
    for (std::size_t c = 0; c < out.value.size(); ++c)
      record.value.col(static_cast<Eigen::Index>(c)) = Eigen::Map<const Eigen::VectorXd>(out.value[c].data(), n);
    record = core::closure::retimed(record, Eigen::Map<const Eigen::VectorXd>(rows.times.t_s.data(), n));
    for (std::size_t c = 0; c < out.value.size(); ++c) {
      const Eigen::VectorXd column = record.value.col(static_cast<Eigen::Index>(c));
      out.value[c].assign(column.begin(), column.end());
    }
    return out;
  }
  const std::uint64_t first = rows.times.number.front();
  const std::size_t cells = n_cells(first, rows.times.number.back(), "displacements");
  for (std::size_t c = 0; c < out.value.size(); ++c) {
    out.value[c].assign(cells, kNan);
    for (std::size_t k = 0; k < rows.times.number.size(); ++k) {
      const std::uint64_t cell = rows.times.number[k] - first;
      if (cell < cells) out.value[c][static_cast<std::size_t>(cell)] = rows.series.value[c][k];
    }
  }
  return out;
}

bool use_measured_times(const std::string& path, ChannelSeries& series) {
  MeasuredRows rows;
  try {
    rows = rows_of_displacements(path, {});
  } catch (const drivers::FileError&) {
    return false;  // a table from another program
  }
  if (!rows.times.are_measured() || rows.series.rate_hz != series.rate_hz) return false;
  const ChannelSeries even = on_grid(rows);
  for (std::size_t c = 0; c < series.channels.size(); ++c) {
    const auto same = std::find_if(even.channels.begin(), even.channels.end(),
                                   [&](const auto& channel) { return channel.name == series.channels[c].name; });
    if (same == even.channels.end()) return false;
    series.value[c] = even.value[static_cast<std::size_t>(same - even.channels.begin())];
  }
  return true;
}

ModalReport report_of(const std::string& folder) {
  const std::filesystem::path path = std::filesystem::path(folder) / "modal.json";
  return std::filesystem::exists(path) ? read_modal_json(path.string()) : ModalReport{};
}

}  // namespace app
