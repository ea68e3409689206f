#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "drivers/camera/device/v4l2_device.h"
#include "drivers/camera/device/v4l2_modes.h"

namespace drivers {

// A camera on Linux's video interface that streams into memory-mapped buffers: opened by name the first time, later
// under whatever name it then has, with the same mode. One thread at a time.
class V4l2Stream {
 public:
  using Deadline = std::chrono::steady_clock::time_point;
  enum class Wait : std::uint8_t { kReady, kDeadline, kStopped, kBroken };

  // node: empty = the only camera attached. Throws DeviceMissing, std::invalid_argument, std::runtime_error.
  V4l2Stream(const std::string& node, const WantedMode& wanted);

  [[nodiscard]] const MadeMode& made() const noexcept { return made_; }
  [[nodiscard]] const V4l2Device& device() const noexcept { return device_; }
  [[nodiscard]] bool is_open() const noexcept { return device_.is_open() && !is_broken_; }
  [[nodiscard]] bool stamps_the_start() const noexcept { return stamps_the_start_; }  // of exposure; false: frame's end
  [[nodiscard]] std::string description() const;  // card, driver, node, format, size

  [[nodiscard]] int begin() noexcept { return device_.stream_on(); }
  void close() noexcept;
  // The stream broke, perhaps because the camera is being removed: it is no longer used, and closed after kTakingAway.
  // Linux 6.1 crashes when the last user closes a node while its driver is removing it (media controller: the list of
  // interfaces is changed without its lock).
  void give_up() noexcept;
  // Opens the same camera again, under its present name. False: it is absent or not ready, or the broken one is not
  // closed yet (a new node returns errors for a moment).
  [[nodiscard]] bool open_again();

  // Waits for a full buffer, `deadline`, a byte in `stop_fd`, or a break of the stream. A closed stream does not break.
  [[nodiscard]] Wait wait(Deadline deadline, int stop_fd) const noexcept;
  // By the input's status: a grabber without a signal streams noise or a blue picture.
  [[nodiscard]] bool has_signal() const noexcept;
  // Whether it has automatic exposure, gain or focus.
  [[nodiscard]] bool adjusts_itself() const noexcept;

 private:
  V4l2Device device_;
  V4l2Identity identity_;
  MadeMode made_;
  bool stamps_the_start_ = false;
  bool is_broken_ = false;
  Deadline closes_at_{};  // for a broken stream
};

[[nodiscard]] std::int64_t stamp_ns(const V4l2Filled& buffer) noexcept;

}  // namespace drivers
