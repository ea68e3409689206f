#include "drivers/camera/camera_factory.h"

#include <fmt/format.h>

#include <stdexcept>

#include "core/simulation/presets.h"
#include "core/simulation/scene.h"
#ifdef HOVERMODAL_WITH_LIBCAMERA
#include "drivers/camera/device/libcamera_camera.h"
#endif
#include "drivers/camera/device/v4l2_camera.h"
#include "drivers/camera/line_timing.h"
#include "drivers/camera/network/stream_camera.h"
#include "drivers/camera/recording/file_camera.h"
#include "drivers/camera/synthetic_camera.h"

namespace drivers {

namespace {

std::unique_ptr<Camera> make_file_camera(const CameraOptions& options) {
  return std::make_unique<FileCamera>(FileCameraConfig{.source = options.source,
                                                       .rate_hz = options.rate_hz,
                                                       .realtime = options.realtime,
                                                       .readout_ms = options.readout_ms,
                                                       .readout_direction = options.readout_direction,
                                                       .decoder_mb = options.decoder_mb,
                                                       .exposure_ms = options.exposure_ms});
}

std::unique_ptr<Camera> make_synthetic_camera(const CameraOptions& options) {
  const LineTiming timing = checked_line_timing(options.readout_ms, options.exposure_ms);
  if (options.readout_direction != core::ReadoutDirection::kDown) {
    throw std::invalid_argument("camera.readout_direction: the synthetic camera reads its rows down only");
  }
  SyntheticCameraConfig config{core::simulation::make_paper_scene(options.synthetic_seed, options.synthetic_duration_s),
                               options.realtime};
  core::simulation::CameraParameters& camera = config.scene.camera;
  if (options.rate_hz != 0.0) camera.rate_hz = options.rate_hz;
  if (timing.readout_ns != 0) camera.readout_s = static_cast<double>(timing.readout_ns) * 1e-9;
  if (timing.exposure_ns != 0) camera.exposure_s = static_cast<double>(timing.exposure_ns) * 1e-9;
  return std::make_unique<SyntheticCamera>(config);
}

std::unique_ptr<Camera> make_v4l2_camera(const CameraOptions& options) {
  return std::make_unique<V4l2Camera>(
      V4l2CameraConfig{.source = options.source,
                       .mode = {options.width_px, options.height_px, options.rate_hz, options.format},
                       .readout_ms = options.readout_ms,
                       .readout_direction = options.readout_direction,
                       .exposure_ms = options.exposure_ms});
}

std::unique_ptr<Camera> make_stream_camera(const CameraOptions& options) {
  return std::make_unique<StreamCamera>(StreamCameraConfig{.source = options.source,
                                                           .transport = options.transport,
                                                           .rate_hz = options.rate_hz,
                                                           .readout_ms = options.readout_ms,
                                                           .readout_direction = options.readout_direction,
                                                           .exposure_ms = options.exposure_ms,
                                                           .decoder_mb = options.decoder_mb});
}

std::unique_ptr<Camera> make_libcamera_camera([[maybe_unused]] const CameraOptions& options) {
#ifdef HOVERMODAL_WITH_LIBCAMERA
  return std::make_unique<LibcameraCamera>(LibcameraCameraConfig{
      .wishes = {options.source, options.width_px, options.height_px, options.rate_hz, options.exposure_ms},
      .readout_ms = options.readout_ms,
      .readout_direction = options.readout_direction});
#else
  throw DeviceMissing(
      "camera.driver = libcamera: this build has no such driver: use 'v4l2', 'file' (a recording) or 'synthetic' "
      "instead, or build it with libcamera-dev installed");
#endif
}

}  // namespace

std::unique_ptr<Camera> make_camera(const CameraOptions& options) {
  switch (options.kind) {
    case CameraKind::kFile:
      return make_file_camera(options);
    case CameraKind::kSynthetic:
      return make_synthetic_camera(options);
    case CameraKind::kV4l2:
      return make_v4l2_camera(options);
    case CameraKind::kLibcamera:
      return make_libcamera_camera(options);
    case CameraKind::kStream:
      return make_stream_camera(options);
  }
  throw std::invalid_argument("camera.driver: unknown kind");
}

}  // namespace drivers
