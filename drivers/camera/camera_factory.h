#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "drivers/camera/camera.h"
#include "drivers/camera/camera_kind.h"
#include "drivers/camera/device_missing.h"

namespace drivers {

struct CameraOptions {
  CameraKind kind = CameraKind::kFile;
  std::string source{};             // file: video or folder; v4l2: a node, empty = the only one; stream: an address
  double rate_hz = 0.0;             // 0 = from the source; for a device its highest
  int width_px = 0, height_px = 0;  // devices: 0 = chosen
  std::string format{};             // v4l2: four characters; empty = chosen
  StreamTransport transport = StreamTransport::kTcp;  // stream
  bool realtime = false;
  double readout_ms = 0.0;                                                   // signed; 0 = global shutter or unknown
  core::ReadoutDirection readout_direction = core::ReadoutDirection::kDown;  // in the image as the sensor stores it
  double exposure_ms = 0.0;                                                  // 0 = unknown
  int decoder_mb = kDecoderMb;                                               // file, stream
  double synthetic_duration_s = 30.0;
  std::uint64_t synthetic_seed = 1;
};

// Throws DeviceMissing if there is no such source or no such driver in this build, std::invalid_argument for a value
// out of range, std::runtime_error for a source that cannot be used.
// Synthetic: rate, readout and exposure, if not 0, replace those of the paper's scene.
[[nodiscard]] std::unique_ptr<Camera> make_camera(const CameraOptions& options);

}  // namespace drivers
