#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/types/frame_prediction.h"

namespace drivers {

// Properties of a recording's packets, without decoding, in the order in which their pictures are shown.
struct PacketScan {
  std::vector<std::int64_t> times_ns;  // presentation times relative to the first; empty: the packets carry none
  std::vector<std::int64_t> ticks;     // the same, in the container's ticks, not shifted
  std::vector<std::uint32_t> bytes;    // sizes
  std::uint64_t n_packets = 0;
  double tick_s = 0.0;
  bool complete = false;  // false: a very large file, of which only the beginning was scanned
  core::FramePrediction prediction = core::FramePrediction::kUnknown;
  double backward_at_s = -1;  // position at which time runs backward by more than a second; -1: none
};

// Reads the file without decoding. Bounded: of a file over a gigabyte or four million packets only a part.
// Throws std::runtime_error where the disk fails.
[[nodiscard]] PacketScan scan_packets(const std::string& path);

}  // namespace drivers
