#pragma once

#include <cstdint>
#include <map>
#include <stdexcept>

#include "core/types/track.h"
#include "drivers/storage/tracks_file.h"
#include "firmware_app/config/config.h"

namespace app {

// The points of a file by their position in its first frame, in the order of the configuration's regions.
class PointPlaces {
 public:
  PointPlaces(const drivers::TracksFile& file, const AppConfig& config) {
    for (std::size_t r = 0; r < config.regions.size(); ++r) {
      for (const core::TrackPoint& point : file.first.points) {
        if (file.region_names[point.region] != config.regions[r].name) continue;
        place_of_id_[point.id] = first_.points.size();
        first_.points.push_back(point);
        first_.points.back().region = static_cast<std::uint16_t>(r);
      }
    }
    if (first_.points.empty())
      throw std::invalid_argument("the tracks have no point in any region of the configuration");
  }

  [[nodiscard]] const core::TrackFrame& first() const noexcept { return first_; }

  // All positions of one frame; a point without a line is marked as not seen.
  void spread(const core::TrackFrame& frame, core::TrackFrame& out) const {
    out = first_;
    out.sequence = frame.sequence;
    out.t_start_ns = frame.t_start_ns;
    out.gap_before = frame.gap_before;
    for (core::TrackPoint& point : out.points) point.seen = false;
    for (const core::TrackPoint& point : frame.points) {
      const auto place = place_of_id_.find(point.id);
      if (place == place_of_id_.end()) continue;
      core::TrackPoint& target = out.points[place->second];
      target.u_px = point.u_px;
      target.v_px = point.v_px;
      target.sigma_px = point.sigma_px;
      target.seen = true;
    }
  }

 private:
  std::map<std::uint32_t, std::size_t> place_of_id_;
  core::TrackFrame first_;
};

}  // namespace app
