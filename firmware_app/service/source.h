#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/channel_displacement.h"
#include "core/geometry/readout_estimator.h"
#include "core/tracking/structure_tracker.h"
#include "core/types/frame.h"
#include "drivers/camera/camera.h"
#include "drivers/telemetry/sample_listener.h"
#include "firmware_app/config/config.h"
#include "firmware_app/service/kept_keyframe.h"

namespace app {

// Of a source that has delivered its first frame.
inline constexpr std::chrono::milliseconds kFrameTimeout{2000};

// The beginning of the data flow, once the first frame is available: all later parts can then be sized.
struct Source {
  // Starts the camera, takes one frame, seeds the points, or finds those of an earlier run's keyframe. Throws
  // ConfigError when configuration and source do not fit, std::runtime_error when no frame comes.
  Source(std::unique_ptr<drivers::Camera> opened, const AppConfig& config);

  [[nodiscard]] const std::vector<core::ChannelInfo>& channels() const noexcept { return displacement.channels(); }
  // The reference image of all displacements.
  [[nodiscard]] const core::Frame& keyframe_image() const noexcept { return kept ? kept->image : first_frame; }

  std::unique_ptr<drivers::Camera> camera;
  core::CameraInfo info;
  core::Frame first_frame;
  std::string datum;                 // whether an earlier run's keyframe is used, and why not; empty: there was none
  std::optional<KeptKeyframe> kept;  // that keyframe, where the view is unchanged
  core::StructureTracker tracker;
  core::TrackFrame keyframe;
  core::ChannelDisplacement displacement;
  core::ReadoutEstimator readout;
};

// Throws drivers::DeviceMissing, ConfigError, std::runtime_error.
[[nodiscard]] std::unique_ptr<drivers::Camera> open_camera(const AppConfig& config);
// Null: not requested.
[[nodiscard]] std::unique_ptr<drivers::AttitudeListener> open_attitude(const AppConfig& config);
[[nodiscard]] std::unique_ptr<drivers::AircraftListener> open_aircraft(const AppConfig& config);

}  // namespace app
