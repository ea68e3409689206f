#pragma once

#include <memory>
#include <string>
#include <vector>

namespace libcamera {
class CameraManager;
}

namespace drivers {

struct LibcameraListing {
  std::string id;
  std::string model;
  std::vector<std::string> modes;  // "NV12 640x480 .. 1920x1080"
};

// The cameras that libcamera finds. Empty also without a running udev daemon, through which libcamera finds cameras.
[[nodiscard]] std::vector<LibcameraListing> list_libcamera_cameras();

// A process may have one manager; it runs while anyone holds it, and detects cameras that come and go. Throws
// std::runtime_error. Any thread.
[[nodiscard]] std::shared_ptr<libcamera::CameraManager> libcamera_manager();

// The id of the camera whose id ends in the given text; empty text = the only camera. Throws DeviceMissing, or
// std::invalid_argument where several match; both list the cameras.
[[nodiscard]] std::string choose_camera(const libcamera::CameraManager& manager, const std::string& wanted);

}  // namespace drivers
