#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/types/frame.h"
#include "core/types/track.h"

namespace drivers {

// A tracks.csv that was read to its end once, every line checked. Its frames are read again by TracksPass, so that a
// record of any length takes the memory of one frame.
struct TracksFile {
  std::string path;
  core::CameraInfo camera;                // from the header comments; description = the file's name
  std::vector<std::string> region_names;  // TrackPoint::region is an index into these
  std::vector<std::string> region_axes;   // as a configuration writes them; empty: the file does not say
  core::TrackFrame first;                 // the first frame
  std::uint64_t last_sequence = 0;        // of the last frame
  std::uint64_t n_frames = 0;
};

// Throws FileError "FILE:LINE: ..." on any deviation from the format: ragged rows, text in place of a number, over-long
// lines, NUL bytes, no header, frames or times that decrease, more than a bound of limits.h.
[[nodiscard]] TracksFile read_tracks_csv(const std::string& path);

// The frames of a file in order, with seen points only; a TrackFrame's sequence is the file's `frame`, and gap_before
// is set where frame numbers jump (also where a frame had no point left).
class TracksPass {
 public:
  explicit TracksPass(const TracksFile& file);  // throws FileError; `file` outlives this
  ~TracksPass();
  // False: the end. Throws FileError where the file has changed since it was checked.
  [[nodiscard]] bool next(core::TrackFrame& out);

 private:
  class Reader;
  friend TracksFile read_tracks_csv(const std::string& path);
  std::unique_ptr<Reader> reader_;
};

}  // namespace drivers
