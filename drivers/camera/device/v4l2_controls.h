#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/camera/device/v4l2_device.h"

namespace drivers {

// Properties that must not change during a measurement: automatic exposure and gain scale the image, focus and
// stabilisation move it.
struct ControlWishes {
  double exposure_ms = 0.0;  // 0 = the value of automatic exposure when it is locked
};

struct LockedControls {
  double exposure_ms = 0.0;  // 0 = not stated by the device
  struct Value {
    std::uint32_t id = 0;
    std::int32_t value = 0;
  };
  std::vector<Value> values;  // in the order in which they were set: to be set again when the camera is back
  std::string text;           // "exposure 8.3 ms, gain 12, focus fixed": what was locked
};

// Call once automatic control has settled. Controls that a device lacks are skipped. Throws std::runtime_error for an
// exposure_ms that the device refuses.
[[nodiscard]] LockedControls lock_controls(const V4l2Device& device, const ControlWishes& wishes);

// What lock_controls() could lock: "exposure, gain, focus"; empty: nothing.
[[nodiscard]] std::string lockable_controls(const V4l2Device& device);

void set_again(const V4l2Device& device, const LockedControls& locked) noexcept;

}  // namespace drivers
