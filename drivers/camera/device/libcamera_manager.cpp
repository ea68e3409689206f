#include "drivers/camera/device/libcamera_manager.h"

#include <fmt/format.h>
#include <libcamera/libcamera.h>

#include <cstdlib>
#include <cstring>
#include <mutex>
#include <stdexcept>

#include "drivers/camera/device_missing.h"

namespace drivers {

namespace lc = libcamera;

std::shared_ptr<lc::CameraManager> libcamera_manager() {
  static std::mutex mutex;
  static std::weak_ptr<lc::CameraManager> shared;
  const std::lock_guard lock(mutex);
  if (auto running = shared.lock()) return running;
  // This program's own messages replace libcamera's. libcamera reads the variable at first use; an existing value is
  // kept.
  setenv("LIBCAMERA_LOG_LEVELS", "*:FATAL", /*overwrite=*/0);
  std::shared_ptr<lc::CameraManager> fresh(new lc::CameraManager, [](lc::CameraManager* ended) {
    ended->stop();
    delete ended;
  });
  if (const int error = fresh->start(); error != 0)
    throw std::runtime_error(fmt::format("libcamera does not start: {}", std::strerror(-error)));
  shared = fresh;
  return fresh;
}

std::string choose_camera(const lc::CameraManager& manager, const std::string& wanted) {
  std::string list;
  std::vector<std::string> fitting;
  for (const auto& camera : manager.cameras()) {
    list += "\n  " + camera->id();
    if (camera->id().ends_with(wanted)) fitting.push_back(camera->id());
  }
  if (fitting.size() == 1) return fitting.front();
  if (list.empty())
    throw DeviceMissing(fmt::format(
        "camera.source = '{}': libcamera sees no camera: is one attached, and does the udev daemon run?", wanted));
  if (fitting.empty())
    throw DeviceMissing(fmt::format("camera.source = {}: no such camera; libcamera sees{}", wanted, list));
  throw std::invalid_argument(fmt::format("camera.source = '{}' fits several cameras: name one of{}", wanted, list));
}

std::vector<LibcameraListing> list_libcamera_cameras() {
  std::vector<LibcameraListing> found;
  const auto manager = libcamera_manager();
  for (const auto& camera : manager->cameras()) {
    LibcameraListing entry{camera->id(), camera->properties().get(lc::properties::Model).value_or(""), {}};
    if (const auto config = camera->generateConfiguration({lc::StreamRole::Viewfinder}); config && !config->empty()) {
      const lc::StreamFormats& formats = config->at(0).formats();
      for (const lc::PixelFormat& format : formats.pixelformats()) {
        const lc::SizeRange range = formats.range(format);
        entry.modes.push_back(
            fmt::format("{} {} .. {}", format.toString(), range.min.toString(), range.max.toString()));
      }
    }
    found.push_back(std::move(entry));
  }
  return found;
}

}  // namespace drivers
