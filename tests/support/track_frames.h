#pragma once

#include <vector>

#include "drivers/storage/tracks_file.h"

namespace tests {

inline std::vector<core::TrackFrame> frames_of(const drivers::TracksFile& file) {
  std::vector<core::TrackFrame> out;
  drivers::TracksPass pass(file);
  for (core::TrackFrame frame; pass.next(frame);) out.push_back(frame);
  return out;
}

}  // namespace tests
