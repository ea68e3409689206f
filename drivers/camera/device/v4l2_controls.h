#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/camera/device/v4l2_device.h"

namespace drivers {

// What must not change while one measures: automatic exposure and gain scale the image, focus and stabilisation move
// it.
struct ControlWishes {
  double exposure_ms = 0.0;  // 0 = as automatic exposure has it when it is locked
};

struct LockedControls {
  double exposure_ms = 0.0;  // 0 = the device does not say
  struct Value {
    std::uint32_t id = 0;
    std::int32_t value = 0;
  };
  std::vector<Value> values;  // as set, in order: to be set again when the camera was gone
  std::string text;           // "exposure 8.3 ms, gain 12, focus fixed": what could be locked
};

// Once automatic control has settled. Controls that a device has not are passed over. Throws std::runtime_error for an
// exposure_ms that the device refuses.
[[nodiscard]] LockedControls lock_controls(const V4l2Device& device, const ControlWishes& wishes);

// The same without doing it: "exposure, gain, focus"; empty: nothing.
[[nodiscard]] std::string lockable_controls(const V4l2Device& device);

void set_again(const V4l2Device& device, const LockedControls& locked) noexcept;

}  // namespace drivers
