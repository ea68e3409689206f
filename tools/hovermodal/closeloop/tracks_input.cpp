#include "tools/hovermodal/closeloop/tracks_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include "core/closure/observation/recent_tracks.h"
#include "drivers/storage/csv.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/chain/observation.h"
#include "firmware_app/report/modal_json.h"

namespace tools {
namespace {

constexpr std::uint64_t kMostFrames = 1'000'000;

// Columns of points in declared regions, in the order of their first appearance.
class Columns {
 public:
  Columns(const drivers::TracksFile& file, const app::AppConfig& config) {
    for (const std::string& name : file.region_names) {
      const auto found = std::find_if(config.regions.begin(), config.regions.end(),
                                      [&](const core::Region& region) { return region.name == name; });
      region_.push_back(found == config.regions.end() ? -1 : static_cast<int>(found - config.regions.begin()));
    }
    for (const core::TrackFrame& frame : file.frames) {
      for (const core::TrackPoint& p : frame.points) {
        if (region_[p.region] < 0 || !column_.emplace(p.id, region_of_point.size()).second) continue;
        region_of_point.push_back(static_cast<std::size_t>(region_[p.region]));
      }
    }
  }
  [[nodiscard]] int column(const core::TrackPoint& p) const {
    const auto found = column_.find(p.id);
    return region_[p.region] < 0 || found == column_.end() ? -1 : static_cast<int>(found->second);
  }
  std::vector<std::size_t> region_of_point;

 private:
  std::vector<int> region_;
  std::map<std::uint32_t, std::size_t> column_;
};

core::closure::ObservationRecord record_of(const drivers::TracksFile& file, const Columns& columns,
                                           const app::DeclaredObservation& declared) {
  const std::uint64_t first = file.frames.front().sequence, last = file.frames.back().sequence;
  core::closure::RecentTracks tracks(declared.record, declared.camera, columns.region_of_point,
                                     static_cast<std::size_t>(last - first) + 1);
  for (const core::TrackFrame& frame : file.frames) {
    if (!tracks.begin_frame(frame.sequence)) continue;
    for (const core::TrackPoint& p : frame.points) {
      if (const int column = columns.column(p); column >= 0) tracks.place(static_cast<std::size_t>(column), p);
    }
  }
  return tracks.record();
}

}  // namespace

TracksInput read_tracks_input(const std::string& path, const app::AppConfig& config) {
  const std::string file_path =
      std::filesystem::is_directory(path) ? (std::filesystem::path(path) / "tracks.csv").string() : path;
  const drivers::TracksFile file = drivers::read_tracks_csv(file_path);
  if (file.frames.empty()) throw drivers::FileError(file_path + ": no frame with a point");
  if (file.frames.back().sequence - file.frames.front().sequence >= kMostFrames)
    throw drivers::FileError(fmt::format("{}: frame numbers extend over {} frames, at most {} are allowed", file_path,
                                         file.frames.back().sequence - file.frames.front().sequence + 1, kMostFrames));
  TracksInput out;
  const Columns columns(file, config);
  if (columns.region_of_point.empty())
    throw drivers::FileError(file_path + ": no point lies in a region of the configuration; is it that of the run?");
  app::DeclaredObservation declared = app::declared_observation(config, file.camera);
  out.record = record_of(file, columns, declared);
  out.warnings = std::move(declared.warnings);
  return out;
}

std::vector<core::Mode> read_known_modes(const std::string& path, const std::vector<std::string>& channels) {
  std::vector<core::Mode> out;
  if (path.empty()) return out;
  if (!path.ends_with(".json")) {
    const drivers::SeriesFile file = drivers::read_foreign_series(path);
    const int column = file.column("frequency_hz");
    if (column < 0) throw drivers::FileError(path + ": no column frequency_hz");
    for (const double hz : file.columns[static_cast<std::size_t>(column)]) {
      if (!(std::isfinite(hz) && hz > 0.0)) throw drivers::FileError(path + ": frequency_hz must be positive numbers");
      out.emplace_back().frequency_hz = hz;
    }
    return out;
  }
  const app::ModalReport report = app::read_modal_json(path);
  for (core::Mode mode : report.estimate.modes) {
    std::vector<std::complex<double>> shape;
    for (const std::string& name : channels) {
      const auto found = std::find(report.channel_names.begin(), report.channel_names.end(), name);
      const auto i = static_cast<std::size_t>(found - report.channel_names.begin());
      if (i < mode.shape.size()) shape.push_back(mode.shape[i]);
    }
    mode.shape = shape.size() == channels.size() ? std::move(shape) : std::vector<std::complex<double>>{};
    out.push_back(std::move(mode));
  }
  return out;
}

}  // namespace tools
