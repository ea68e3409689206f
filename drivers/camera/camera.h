#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "core/types/frame.h"
#include "core/types/recording_times.h"

namespace drivers {

enum class CaptureStatus : std::uint8_t { kFrame, kTimeout, kEndOfStream, kFault };

// What a device did that it should not, so far.
struct DeviceTrouble {
  bool is_lost = false;               // no frames now: unplugged, broken off or silent; the driver keeps looking for it
  std::uint64_t n_interruptions = 0;  // how often it was lost
  std::uint64_t n_damaged = 0;  // frames that came, but marked as bad by the device, short or undecodable; not used
  bool has_no_clock = false;    // its stamps are on no clock of ours: times are those of arrival
};

// Where frames come from. Set-up (construction, start) may throw; `capture` never does, and is called by one thread.
// Time stamps: each driver states which instant its device stamps, and converts to the start of exposure of row 0.
class Camera {
 public:
  virtual ~Camera() = default;
  // Size, nominal rate and description from construction on; a device may know exposure, readout and its true rate only
  // after `start`. Not while another thread captures.
  [[nodiscard]] virtual core::CameraInfo info() const = 0;
  // Throws std::runtime_error: what, which value, what to try. Again after `stop`: a device goes on with what it sees
  // then, a recording and a scene begin anew.
  virtual void start() = 0;
  // Fills `out` (pixels already sized width x height by the caller; never reallocated here). Waits at most `timeout`.
  virtual CaptureStatus capture(core::Frame& out, std::chrono::milliseconds timeout) noexcept = 0;
  // Any thread; `capture` returns soon, with kEndOfStream from then on, and no slot is written after it. Twice is once.
  virtual void stop() noexcept = 0;
  // After kFault (and for a file that ended early): what went wrong, for the log. Empty when all is well.
  [[nodiscard]] virtual std::string fault() const { return {}; }
  [[nodiscard]] virtual DeviceTrouble trouble() const noexcept { return {}; }  // any thread
  // A recording: how even its times are, and what it lacked so far. Any thread.
  [[nodiscard]] virtual core::RecordingTimes times() const { return {}; }
};

}  // namespace drivers
