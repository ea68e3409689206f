#include "drivers/camera/camera_list.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "drivers/camera/camera_kind.h"
#include "drivers/camera/device/v4l2_controls.h"
#include "drivers/camera/device/v4l2_stream.h"
#ifdef HOVERMODAL_WITH_LIBCAMERA
#include "drivers/camera/device/libcamera_manager.h"
#endif

namespace drivers {

namespace fs = std::filesystem;

namespace {

// The udev link to this node: by the device's name and serial number, otherwise by the port it is connected to.
std::string lasting_name(const std::string& node) {
  for (const char* folder : {"/dev/v4l/by-id", "/dev/v4l/by-path"}) {
    std::error_code error;
    for (const fs::directory_entry& link : fs::directory_iterator(folder, error)) {
      if (fs::canonical(link.path(), error) == fs::path(node)) return link.path();
    }
  }
  return node;
}

AttachedCamera look_at(const std::string& node) {
  AttachedCamera camera;
  camera.driver = to_string(CameraKind::kV4l2);
  camera.source = lasting_name(node);
  try {
    const V4l2Stream stream(node, {});
    const V4l2Device& device = stream.device();
    const V4l2Mode& mode = stream.made().mode;
    camera.name = fmt::format("{} ({}, {}, {})", device.identity().card, node, device.identity().driver,
                              device.identity().bus_info);
    for (const V4l2Mode& offered : list_modes(device, {})) camera.modes.push_back(mode_text(offered));
    camera.stamps =
        stream.stamps_the_start() ? "start of exposure" : "end of the frame: readout and exposure are subtracted";
    camera.locks = lockable_controls(device);
    camera.width_px = mode.width_px;
    camera.height_px = mode.height_px;
    camera.rate_hz = mode.rate_hz;
    camera.format = fourcc_text(mode.fourcc);
  } catch (const std::exception& thrown) {
    if (camera.name.empty()) camera.name = node;
    camera.problem = thrown.what();
  }
  return camera;
}

}  // namespace

std::vector<AttachedCamera> list_cameras() {
  std::vector<AttachedCamera> cameras;
  for (const std::string& node : capture_nodes()) cameras.push_back(look_at(node));
#ifdef HOVERMODAL_WITH_LIBCAMERA
  for (LibcameraListing& listed : list_libcamera_cameras()) {
    AttachedCamera camera;
    camera.driver = to_string(CameraKind::kLibcamera);
    camera.source = listed.id;
    camera.name = listed.model.empty() ? listed.id : listed.model + " (" + listed.id + ")";
    camera.modes = std::move(listed.modes);
    camera.stamps = "start of exposure of the first row (SensorTimestamp), where the camera gives it";
    cameras.push_back(std::move(camera));
  }
#endif
  return cameras;
}

}  // namespace drivers
