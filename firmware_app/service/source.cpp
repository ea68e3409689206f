#include "firmware_app/service/source.h"

#include <fmt/core.h>

#include <chrono>
#include <stdexcept>
#include <utility>

#include "core/tracking/view_match.h"
#include "drivers/camera/camera_factory.h"
#include "firmware_app/config/config_image.h"
#include "firmware_app/config/config_timing.h"
#include "firmware_app/config/core_config.h"
#include "firmware_app/service/kept_state.h"

namespace app {
namespace {

constexpr std::chrono::seconds kFirstFrameTimeout{10};

// Starts the camera once its source fits the configuration; only then are its properties complete (exposure, readout,
// rate).
core::CameraInfo started(drivers::Camera& camera, const AppConfig& config) {
  const core::CameraInfo info = camera.info();
  check_against_image(config, info.width_px, info.height_px);
  check_against_rate(config, info.rate_hz);
  const auto segment = static_cast<std::uint64_t>(config.spectrum.segment);
  if (info.frame_count != 0 && info.frame_count < segment) {
    throw ConfigError(
        fmt::format("spectrum.segment: {} frames in {} are fewer than one segment of {}: film at least {:.1f} s at "
                    "{:g} fps, or set spectrum.segment to {} or less",
                    info.frame_count, config.camera.source, segment, static_cast<double>(segment) / info.rate_hz,
                    info.rate_hz, info.frame_count));
  }
  camera.start();
  return camera.info();
}

core::Frame take_first_frame(drivers::Camera& camera, const core::CameraInfo& info) {
  core::Frame frame;
  frame.width_px = info.width_px;
  frame.height_px = info.height_px;
  frame.pixels.resize(static_cast<std::size_t>(info.width_px) * static_cast<std::size_t>(info.height_px));
  if (camera.capture(frame, kFirstFrameTimeout) != drivers::CaptureStatus::kFrame) {
    const std::string why = camera.fault();
    throw std::runtime_error(fmt::format("{}: no first frame within {} s{}{}", info.description,
                                         kFirstFrameTimeout.count(), why.empty() ? "" : ": ", why));
  }
  return frame;
}

// Finds the kept points in the first frame; where they are not found, `kept` is emptied and `datum` states why.
core::StructureTracker tracker_of_kept(const AppConfig& config, const core::Frame& first,
                                       std::optional<KeptKeyframe>& kept, std::string& datum) {
  core::StructureTracker tracker(tracker_config(config));
  tracker.set_keyframe(kept->image, kept->points);
  core::TrackFrame found = kept->points;
  (void)tracker.track(first, found);
  const std::string other = core::why_other_view(kept->points, found, config.tracking.min_points);
  datum = other.empty() ? "displacements are measured from the keyframe of the run before"
                        : "points are seeded again: " + other;
  if (!other.empty()) {
    kept.reset();
    return tracker;
  }
  tracker.learn(found);  // the next frame's search starts from these positions
  kept->points.sequence = first.sequence;
  kept->points.t_start_ns = first.t_start_ns;
  return tracker;
}

std::optional<KeptKeyframe> find_kept(const AppConfig& config, const core::CameraInfo& info, std::string& datum) {
  if (config.state.directory.empty()) return {};
  KeyframeRead read = read_keyframe(keyframe_path(config), config.hash, info, config.regions.size());
  if (!read.refused.empty()) datum = "points are seeded again: " + read.refused;
  return std::move(read.keyframe);
}

core::StructureTracker started_tracker(const AppConfig& config, const core::Frame& first,
                                       std::optional<KeptKeyframe>& kept, std::string& datum) {
  if (kept) {
    core::StructureTracker tracker = tracker_of_kept(config, first, kept, datum);
    if (kept) return tracker;
  }
  core::StructureTracker tracker(tracker_config(config));
  if (const std::string refused = tracker.seed(first); !refused.empty()) throw ConfigError("regions: " + refused);
  return tracker;
}

// The seeds as the first frame's tracks: the tracker finds each point at its seed.
core::TrackFrame track_keyframe(core::StructureTracker& tracker, const core::Frame& first) {
  core::TrackFrame keyframe;
  keyframe.points.resize(tracker.n_points());
  (void)tracker.track(first, keyframe);
  return keyframe;
}

}  // namespace

Source::Source(std::unique_ptr<drivers::Camera> opened, const AppConfig& config)
    : camera(std::move(opened)),
      info(started(*camera, config)),
      first_frame(take_first_frame(*camera, info)),
      kept(find_kept(config, info, datum)),
      tracker(started_tracker(config, first_frame, kept, datum)),
      keyframe(kept ? kept->points : track_keyframe(tracker, first_frame)),
      displacement(displacement_config(config, info), keyframe),
      readout(readout_config(config, info), keyframe) {}

std::unique_ptr<drivers::Camera> open_camera(const AppConfig& config) {
  const CameraConfig& c = config.camera;
  drivers::CameraOptions options;
  options.kind = c.driver;
  options.source = c.source;
  options.transport = c.transport;
  options.rate_hz = c.rate_hz;
  options.width_px = c.size_px[0];
  options.height_px = c.size_px[1];
  options.format = c.format;
  options.realtime = c.pace == Pace::kRealtime;
  options.readout_ms = c.readout_ms;
  options.readout_direction = c.readout_direction;
  options.exposure_ms = c.exposure_ms;
  options.decoder_mb = c.decoder_mb;
  options.synthetic_duration_s = c.synthetic_duration_s;
  options.synthetic_seed = c.synthetic_seed;
  return drivers::make_camera(options);
}

std::unique_ptr<drivers::AttitudeListener> open_attitude(const AppConfig& config) {
  if (config.camera.attitude_channel.empty()) return nullptr;
  return drivers::listen_for_attitude(config.telemetry.lcm_url, config.camera.attitude_channel);
}

std::unique_ptr<drivers::AircraftListener> open_aircraft(const AppConfig& config) {
  if (config.camera.aircraft_channel.empty()) return nullptr;
  return drivers::listen_for_aircraft(config.telemetry.lcm_url, config.camera.aircraft_channel);
}

}  // namespace app
