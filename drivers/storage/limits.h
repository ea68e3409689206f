#pragma once

#include <cstddef>
#include <cstdint>

// The bounds of everything that is read from files, in one place. A reader refuses what exceeds its bound, with file,
// number and bound in words, before it takes the memory. Files are opened by open_regular_file() (regular_file.h).
namespace drivers {

struct Limits {
  static constexpr std::size_t kKiB = 1U << 10U, kMiB = 1U << 20U;

  static constexpr std::size_t kLineBytes = 64 * kKiB;         // of any text that is read line by line
  static constexpr std::uint64_t kImagePixels = 1U << 26U;     // 8192 x 8192: of a still image or a frame of a video
  static constexpr std::uint64_t kSubtitleBytes = 512 * kMiB;  // of a .SRT
  static constexpr std::uint64_t kRawTelemetryBytes = 512 * kMiB;  // of a raw GPMF file
  static constexpr std::uint64_t kTimestamps = 20'000'000;       // frames with a time of their own: ten days at 25 fps
  static constexpr std::uint64_t kRecordEventBytes = 64 * kMiB;  // of one event in a record or log of messages
  static constexpr std::uint64_t kStateBytes = std::uint64_t{4} << 30U;  // of a checkpoint
  static constexpr std::size_t kColumns = 4096;                          // of a table
  static constexpr std::size_t kPointsPerRegion = 4096;                  // of one frame in tracks
  static constexpr std::size_t kRegions = 4096;                          // in tracks
};

}  // namespace drivers
