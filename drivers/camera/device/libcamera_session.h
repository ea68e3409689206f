#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/camera/device/luma.h"
#include "rt/wakeup.h"

namespace drivers {

struct LibcameraWishes {
  std::string camera{};             // its id, or the end of it; empty = the only one attached
  int width_px = 0, height_px = 0;  // 0 = the largest up to 1920 x 1080
  double rate_hz = 0.0;             // 0 = the camera's own
  double exposure_ms = 0.0;         // 0 = automatic, until it is locked
};

// One camera of libcamera. Together with libcamera_manager.cpp and libcamera_modes.cpp it contains all knowledge of
// that library (0.0.3): later versions change these files only. libcamera's thread calls back with completed requests,
// which are only put into a ring. One thread at a time, except where stated.
class LibcameraSession {
 public:
  // Finds the camera and determines format and size. Throws DeviceMissing, std::invalid_argument, std::runtime_error.
  LibcameraSession(const LibcameraWishes& wishes, rt::Wakeup& wakeup);
  ~LibcameraSession();
  LibcameraSession(const LibcameraSession&) = delete;
  LibcameraSession& operator=(const LibcameraSession&) = delete;

  [[nodiscard]] int width_px() const noexcept;
  [[nodiscard]] int height_px() const noexcept;
  [[nodiscard]] std::string description() const;  // id, format, size

  // Acquires the camera again, with the same mode, if it was closed, and streams. Returns the reason of a failure.
  [[nodiscard]] std::string run();
  void halt() noexcept;   // no callback comes after it
  void close() noexcept;  // releases the camera
  [[nodiscard]] bool is_running() const noexcept;
  [[nodiscard]] bool is_gone() const noexcept;  // unplugged, as reported by libcamera
  // Unplugged, as shown by its nodes: libcamera does not report the end of every camera. Searches the open files.
  [[nodiscard]] bool has_vanished() const;

  struct Done {
    std::size_t cookie = 0;
    bool is_whole = false;         // the frame has no error
    std::uint32_t sequence = 0;    // the device's
    std::int64_t stamp_ns = 0;     // start of exposure if the camera states it, else the buffer's stamp
    std::int64_t exposure_ns = 0;  // 0 = not stated
    std::int64_t readout_ns = 0;   // first to last row; 0 = not stated
    const std::uint8_t* bytes = nullptr;
    std::size_t n_bytes = 0;
  };
  [[nodiscard]] std::optional<Done> next() noexcept;  // empty: wait for the wakeup
  [[nodiscard]] LumaStatus read(const Done& done, std::uint8_t* luma) noexcept;
  // Queues its buffer again. lock: automatic exposure, gain, white balance and focus stop at their present values.
  // Not noexcept: libcamera allocates. False: the camera refuses.
  [[nodiscard]] bool give_back(const Done& done, bool lock);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace drivers
