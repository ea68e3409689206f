#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "core/types/frame.h"

namespace drivers {

enum class CaptureStatus : std::uint8_t { kFrame, kTimeout, kEndOfStream, kFault };

// Where frames come from. Set-up (construction, start) may throw; `capture` never does, and is called by one thread.
// Time stamps: each driver states which instant its device stamps, and converts to the start of exposure of row 0.
class Camera {
 public:
  virtual ~Camera() = default;
  [[nodiscard]] virtual core::CameraInfo info() const = 0;  // valid after construction
  virtual void start() = 0;                                 // throws std::runtime_error: what, which value, what to try
  // Fills `out` (pixels already sized width x height by the caller; never reallocated here). Waits at most `timeout`.
  virtual CaptureStatus capture(core::Frame& out, std::chrono::milliseconds timeout) noexcept = 0;
  virtual void stop() noexcept = 0;
  // After kFault (and for a file that ended early): what went wrong, for the log. Empty when all is well.
  [[nodiscard]] virtual std::string fault() const { return {}; }
};

}  // namespace drivers
