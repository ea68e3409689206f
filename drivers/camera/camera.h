#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "core/types/frame.h"
#include "core/types/recording_times.h"

namespace drivers {

enum class CaptureStatus : std::uint8_t { kFrame, kTimeout, kEndOfStream, kFault };

// Faults of a device so far.
struct DeviceTrouble {
  bool is_lost = false;               // no frames now: unplugged, interrupted or silent; being searched for
  std::uint64_t n_interruptions = 0;  // how often it was lost
  std::uint64_t n_damaged = 0;        // frames received but not used: marked as bad by the device, short or undecodable
  bool has_no_clock = false;          // its stamps are on no known clock: arrival times are used
};

// Source of frames. Set-up (construction, start) may throw; `capture` never does, and is called by one thread.
// Time stamps: each driver states which instant its device stamps, and converts to the start of exposure of row 0.
class Camera {
 public:
  virtual ~Camera() = default;
  // Size, nominal rate and description from construction on; a device may know exposure, readout and its true rate only
  // after `start`. Do not call while another thread captures.
  [[nodiscard]] virtual core::CameraInfo info() const = 0;
  // Throws std::runtime_error: what, which value, what to try. May be called again after `stop`: a device continues
  // with the present view, a recording and a scene start from the beginning.
  virtual void start() = 0;
  // Fills `out` (pixels already sized width x height by the caller; never reallocated here). Waits at most `timeout`.
  virtual CaptureStatus capture(core::Frame& out, std::chrono::milliseconds timeout) noexcept = 0;
  // Any thread; `capture` returns soon, with kEndOfStream from then on, and writes no slot afterwards. Idempotent.
  virtual void stop() noexcept = 0;
  // After kFault (and for a file that ended early): the reason, for the log. Empty if there is none.
  [[nodiscard]] virtual std::string fault() const { return {}; }
  [[nodiscard]] virtual DeviceTrouble trouble() const noexcept { return {}; }  // any thread
  // For a recording: how even its times are, and its losses so far. Any thread.
  [[nodiscard]] virtual core::RecordingTimes times() const { return {}; }
};

}  // namespace drivers
