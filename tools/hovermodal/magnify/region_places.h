#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/types/vector2.h"
#include "drivers/storage/tracks_file.h"

namespace tools {

// Where a run's regions are in each frame, from its tracks.csv: the mean shift of a region's points since the first
// frame.
class RegionPlaces {
 public:
  // `names`: of the regions asked for, as shifts() gives them. Throws drivers::FileError.
  RegionPlaces(const std::string& tracks_csv, const std::vector<std::string>& names);
  RegionPlaces(const RegionPlaces&) = delete;
  RegionPlaces& operator=(const RegionPlaces&) = delete;

  // In pixels, at this frame number of the clip; numbers must not decrease. A region that is not seen keeps its last
  // shift. False: the tracks end before this frame.
  bool advance(std::uint64_t sequence);
  [[nodiscard]] const std::vector<core::Vector2>& shifts() const noexcept { return shift_; }
  [[nodiscard]] std::uint64_t n_frames() const noexcept { return file_.n_frames; }

 private:
  void take(const core::TrackFrame& frame);

  drivers::TracksFile file_;
  drivers::TracksPass pass_;
  std::vector<int> asked_;                        // per region of the file: index of the name, -1 none
  std::map<std::uint32_t, core::Vector2> first_;  // place of a point in the first frame
  std::vector<core::Vector2> shift_;
  core::TrackFrame next_;
  bool has_next_ = false;
};

}  // namespace tools
