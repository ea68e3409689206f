#include "drivers/camera/device/v4l2_controls.h"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>

namespace drivers {

namespace {

constexpr double kExposureUnit_ms = 0.1;  // of V4L2_CID_EXPOSURE_ABSOLUTE

class Controls {
 public:
  Controls(const V4l2Device& device, LockedControls& locked) : device_(device), locked_(locked) {}

  [[nodiscard]] bool has(std::uint32_t id) const noexcept {
    v4l2_queryctrl query{};
    query.id = id;
    return device_.call(VIDIOC_QUERYCTRL, query) == 0 && (query.flags & V4L2_CTRL_FLAG_DISABLED) == 0;
  }
  [[nodiscard]] std::optional<std::int32_t> get(std::uint32_t id) const noexcept {
    v4l2_control control{id, 0};
    if (!has(id) || device_.call(VIDIOC_G_CTRL, control) != 0) return std::nullopt;
    return control.value;
  }
  [[nodiscard]] int set(std::uint32_t id, std::int32_t value) {
    if (!has(id)) return EINVAL;
    v4l2_control control{id, value};
    const int error = device_.call(VIDIOC_S_CTRL, control);
    if (error == 0) locked_.values.push_back({id, value});
    return error;
  }
  void tell(const std::string& what) { locked_.text += (locked_.text.empty() ? "" : ", ") + what; }
  // Switches a control off if the device has it; `words` describes the result.
  void switch_off(std::uint32_t id, const char* words) {
    if (set(id, 0) == 0) tell(words);
  }

 private:
  const V4l2Device& device_;
  LockedControls& locked_;
};

// Reads the value of automatic control before switching it off, because not every device keeps it.
void lock_exposure(Controls& controls, const V4l2Device& device, double wanted_ms, LockedControls& locked) {
  const std::optional<std::int32_t> automatic = controls.get(V4L2_CID_EXPOSURE_ABSOLUTE);
  (void)controls.set(V4L2_CID_EXPOSURE_AUTO_PRIORITY, 0);  // otherwise it may lower the frame rate in the dark
  const bool is_manual = controls.set(V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL) == 0;
  if (!automatic) {
    if (wanted_ms > 0) {
      locked.exposure_ms = wanted_ms;
      controls.tell(fmt::format("exposure not settable, taken to be {:g} ms as declared", wanted_ms));
    } else if (is_manual) {
      controls.tell("exposure fixed");
    }
    return;
  }
  const std::int32_t units =
      wanted_ms > 0 ? static_cast<std::int32_t>(std::lround(wanted_ms / kExposureUnit_ms)) : *automatic;
  if (const int error = controls.set(V4L2_CID_EXPOSURE_ABSOLUTE, units); error != 0 && wanted_ms > 0) {
    throw std::runtime_error(
        fmt::format("{}: camera.exposure_ms = {:g} refused: {}: 0 keeps what automatic exposure finds", device.path(),
                    wanted_ms, std::strerror(error)));
  }
  locked.exposure_ms = kExposureUnit_ms * controls.get(V4L2_CID_EXPOSURE_ABSOLUTE).value_or(units);
  controls.tell(fmt::format("exposure {:.4g} ms", locked.exposure_ms));
}

}  // namespace

LockedControls lock_controls(const V4l2Device& device, const ControlWishes& wishes) {
  LockedControls locked;
  Controls controls(device, locked);
  lock_exposure(controls, device, wishes.exposure_ms, locked);
  const std::optional<std::int32_t> gain = controls.get(V4L2_CID_GAIN);
  (void)controls.set(V4L2_CID_AUTOGAIN, 0);
  if (gain && controls.set(V4L2_CID_GAIN, *gain) == 0) controls.tell(fmt::format("gain {}", *gain));
  controls.switch_off(V4L2_CID_FOCUS_AUTO, "focus fixed");
  controls.switch_off(V4L2_CID_AUTO_WHITE_BALANCE, "white balance fixed");
  controls.switch_off(V4L2_CID_IMAGE_STABILIZATION, "stabilisation off");
  controls.switch_off(V4L2_CID_WIDE_DYNAMIC_RANGE, "wide dynamic range off");
  return locked;
}

std::string lockable_controls(const V4l2Device& device) {
  LockedControls none;
  const Controls controls(device, none);
  std::string text;
  for (const auto& [id, words] :
       {std::pair{V4L2_CID_EXPOSURE_ABSOLUTE, "exposure"}, std::pair{V4L2_CID_GAIN, "gain"},
        std::pair{V4L2_CID_FOCUS_AUTO, "focus"}, std::pair{V4L2_CID_AUTO_WHITE_BALANCE, "white balance"}}) {
    if (controls.has(static_cast<std::uint32_t>(id))) text += (text.empty() ? "" : ", ") + std::string(words);
  }
  return text;
}

void set_again(const V4l2Device& device, const LockedControls& locked) noexcept {
  for (const LockedControls::Value& wanted : locked.values) {
    v4l2_control control{wanted.id, wanted.value};
    (void)device.call(VIDIOC_S_CTRL, control);
  }
}

}  // namespace drivers
