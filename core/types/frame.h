#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace core {

// Direction in which the sensor's lines are read, in the delivered (already rotated) image.
enum class ReadoutDirection : std::uint8_t { kDown, kUp, kLeft, kRight };

// Lines are rows of the image, not columns.
[[nodiscard]] constexpr bool reads_rows(ReadoutDirection direction) noexcept {
  return direction == ReadoutDirection::kDown || direction == ReadoutDirection::kUp;
}
// "down", "up", "left", "right": as in every file and message.
[[nodiscard]] const char* to_string(ReadoutDirection direction) noexcept;

// Properties of a camera that are known before its first frame and fixed while it runs.
struct CameraInfo {
  int width_px = 0;
  int height_px = 0;
  double rate_hz = 0.0;         // nominal frame rate; > 0
  std::int64_t readout_ns = 0;  // first to last line along the direction; signed; 0 = global shutter or unknown
  ReadoutDirection readout_direction = ReadoutDirection::kDown;
  std::int64_t exposure_ns = 0;   // 0 = unknown
  std::uint64_t frame_count = 0;  // 0 = unknown (a live source)
  bool lossless = false;          // the source can wait (a file): a full ring delays it and no frame is dropped
  std::string description;        // for logs: device or file, codec, size
  // Largest block of the image that has one motion vector in a compressed recording; 0: not compressed between frames,
  // or at so many bits per pixel that the blocks do not show.
  int coding_block_px = 0;
};

// One gray image and its time. A ring slot: `pixels` is sized once, at set-up, and reused.
struct Frame {
  std::uint64_t sequence = 0;    // frame number at the source; jumps where frames were lost
  std::int64_t t_start_ns = 0;   // start of exposure of row 0 (stream time for files, CLOCK_MONOTONIC for devices)
  std::int64_t exposure_ns = 0;  // 0 = unknown
  std::int64_t t_taken_ns = 0;   // CLOCK_MONOTONIC when the service received it; for latencies only, not for results
  bool gap_before = false;       // at least one frame is missing between this and the previous one
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> pixels;  // height x width, row-major, no padding
};

}  // namespace core
