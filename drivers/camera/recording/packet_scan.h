#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace drivers {

// What the packets of a recording say before one is decoded, in the order in which their pictures are shown.
struct PacketScan {
  std::vector<std::int64_t> times_ns;  // presentation times after the first; empty: the packets carry none
  std::vector<std::int64_t> ticks;     // the same, in the container's ticks, not shifted
  std::vector<std::uint32_t> bytes;    // sizes
  std::uint64_t n_packets = 0;
  double tick_s = 0.0;
  bool complete = false;      // false: a very large file, of which the beginning was looked through
  double backward_at_s = -1;  // here the file's own order of time runs backward by more than a second; -1: nowhere
};

// Reads through the file without decoding. Bounded: a file over a gigabyte or four million packets in part.
[[nodiscard]] PacketScan scan_packets(const std::string& path);

}  // namespace drivers
