#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace drivers {

// A message of MAVLink 2 (https://mavlink.io/en/guide/serialization.html). Missing bytes at its end are zero, as the
// sender leaves them out.
struct MavlinkFrame {
  std::uint32_t id = 0;
  std::uint8_t sequence = 0, system = 0, component = 0;
  std::array<std::uint8_t, 255> payload{};
};

inline constexpr std::size_t kMavlinkMostBytes = 280;  // header 10, payload 255, checksum 2, signature 13

[[nodiscard]] std::uint16_t mavlink_checksum(std::span<const std::uint8_t> bytes, std::uint8_t crc_extra) noexcept;

// Bytes of the frame in `out`; returns how many. The id must be in kMavlinkLayouts; otherwise 0.
[[nodiscard]] std::size_t write_mavlink(const MavlinkFrame& frame,
                                        std::array<std::uint8_t, kMavlinkMostBytes>& out) noexcept;

// Finds the frames in a stream of bytes, whatever they are. A frame counts only with its checksum; after a wrong one
// the search goes on at the byte behind its start, so that noise never costs the frame that follows it. Without
// allocation.
class MavlinkParser {
 public:
  struct Counts {
    std::uint64_t frames = 0;
    std::uint64_t skipped_bytes = 0;  // of no frame, of frames of unknown ids or with unknown flags, of MAVLink 1
    std::uint64_t wrong_checksums = 0;
  };

  // Calls on_frame(const MavlinkFrame&) for each frame that these bytes complete.
  template <class OnFrame>
  void push(std::span<const std::uint8_t> bytes, const OnFrame& on_frame) {
    for (const std::uint8_t byte : bytes) {
      buffer_[n_++] = byte;
      MavlinkFrame frame;
      while (take(frame)) on_frame(frame);
    }
  }
  // A datagram holds whole frames: what is left of one is none.
  void end_datagram() noexcept;
  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }

 private:
  [[nodiscard]] bool take(MavlinkFrame& frame) noexcept;  // from the front of the buffer
  void skip(std::size_t bytes) noexcept;

  std::array<std::uint8_t, kMavlinkMostBytes> buffer_{};
  std::size_t n_ = 0;
  Counts counts_;
};

}  // namespace drivers
