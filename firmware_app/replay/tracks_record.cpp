#include "firmware_app/replay/tracks_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include "core/closure/observation/recent_tracks.h"
#include "drivers/host/memory_left.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/chain/observation.h"
#include "firmware_app/replay/tracks_axes.h"

namespace app {
namespace {

std::size_t n_frames_of(const drivers::TracksFile& file) {  // with those that are missing
  return static_cast<std::size_t>(file.last_sequence - file.first.sequence) + 1;
}

// Columns of points in declared regions, in the order of their first appearance.
class Columns {
 public:
  Columns(const drivers::TracksFile& file, const AppConfig& config) {
    for (const std::string& name : file.region_names) {
      const auto found = std::find_if(config.regions.begin(), config.regions.end(),
                                      [&](const core::Region& region) { return region.name == name; });
      region_.push_back(found == config.regions.end() ? -1 : static_cast<int>(found - config.regions.begin()));
    }
    drivers::TracksPass frames(file);
    for (core::TrackFrame frame; frames.next(frame);) {
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

// Of the diagnosis at its peak.
void require_memory(const drivers::TracksFile& file, std::size_t n_frames, std::size_t n_points) {
  constexpr double kGB = 1e9;
  constexpr double kBytesPerCell = 1200.0;  // measured: 1140 B from 240 000 to 960 000 cells
  const double needed = kBytesPerCell * static_cast<double>(n_frames) * static_cast<double>(n_points);
  if (const auto left = static_cast<double>(drivers::memory_left()); needed > left)
    throw drivers::FileError(
        fmt::format("{}: {} points in {} frames take {:.2g} GB, and {:.2g} GB of memory are left; track fewer points "
                    "(tracking.points_per_region), or divide the record",
                    file.path, n_points, n_frames, needed / kGB, left / kGB));
}

core::closure::ObservationRecord record_of(const drivers::TracksFile& file, const Columns& columns,
                                           const DeclaredObservation& declared, std::size_t n_frames) {
  core::closure::RecentTracks tracks(declared.record, declared.camera, columns.region_of_point, n_frames);
  drivers::TracksPass frames(file);
  for (core::TrackFrame frame; frames.next(frame);) {
    if (!tracks.begin_frame(frame.sequence)) continue;
    for (const core::TrackPoint& p : frame.points) {
      if (const int column = columns.column(p); column >= 0) tracks.place(static_cast<std::size_t>(column), p);
    }
  }
  return tracks.record();
}

}  // namespace

TracksRecord read_tracks_record(const std::string& path, const AppConfig& config) {
  const std::string file_path =
      std::filesystem::is_directory(path) ? (std::filesystem::path(path) / "tracks.csv").string() : path;
  return tracks_record(drivers::read_tracks_csv(file_path), config);
}

TracksRecord tracks_record(const drivers::TracksFile& file, const AppConfig& given, std::size_t most_frames) {
  const std::size_t n_frames = std::min(n_frames_of(file), std::max<std::size_t>(1, most_frames));
  if (n_frames > kMostRecordFrames)
    throw drivers::FileError(
        fmt::format("{}: frame numbers extend over {} frames, at most {} are allowed; divide the record", file.path,
                    n_frames, kMostRecordFrames));
  const AppConfig config = with_axes_of(file, given);
  TracksRecord out;
  const Columns columns(file, config);
  if (columns.region_of_point.empty())
    throw drivers::FileError(file.path + ": no point lies in a region of the configuration; is it that of the run?");
  require_memory(file, n_frames, columns.region_of_point.size());
  DeclaredObservation declared = declared_observation(config, file.camera);
  out.record = record_of(file, columns, declared, n_frames);
  out.warnings = std::move(declared.warnings);
  return out;
}

}  // namespace app
