#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "drivers/camera/camera.h"

namespace test_support {

inline core::Frame make_slot(const core::CameraInfo& info) {
  core::Frame slot;
  slot.pixels.resize(static_cast<std::size_t>(info.width_px) * static_cast<std::size_t>(info.height_px));
  return slot;
}

struct Drained {
  std::vector<core::Frame> frames;
  drivers::CaptureStatus last = drivers::CaptureStatus::kTimeout;
  std::string fault;
};

// Captures from a started camera until its stream ends or fails.
inline Drained drain(drivers::Camera& camera) {
  Drained run;
  core::Frame slot = make_slot(camera.info());
  for (;;) {
    run.last = camera.capture(slot, std::chrono::milliseconds(1000));
    if (run.last == drivers::CaptureStatus::kFrame) {
      run.frames.push_back(slot);
    } else if (run.last != drivers::CaptureStatus::kTimeout) {
      break;
    }
  }
  run.fault = camera.fault();
  return run;
}

}  // namespace test_support
