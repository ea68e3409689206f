#include "firmware_app/config/core_config.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <optional>

#include "core/geometry/keyframe_view.h"
#include "core/geometry/slow_rotation.h"
#include "core/identification/steady_lines.h"
#include "core/types/constants.h"
#include "drivers/host/memory_left.h"
#include "drivers/storage/attitude_file.h"
#include "drivers/storage/motors_file.h"
#include "firmware_app/config/calibration.h"
#include "firmware_app/config/region_axis.h"
#include "firmware_app/config/structure_scale.h"

namespace app {

namespace {

using core::kRadPerDeg;
// An inline camera matrix alone states only the optical axis; a calibration file is assumed to describe the lens.
bool undistorts(const CalibrationConfig& calibration) {
  const auto& k = calibration.distortion;
  return !calibration.file.empty() ||
         (calibration.fx > 0.0 && (calibration.model == core::LensModel::kEquidistant ||
                                   std::any_of(k.begin(), k.end(), [](double value) { return value != 0.0; })));
}

std::optional<core::AttitudeConfig> attitude_config(const AppConfig& config, const core::CameraInfo& camera) {
  const CameraConfig& c = config.camera;
  if (c.attitude_file.empty() && c.attitude_channel.empty()) return std::nullopt;
  core::AttitudeConfig out;
  out.sigma_rad = c.attitude_sigma_deg * kRadPerDeg;
  for (std::size_t i = 0; i < 3; ++i) out.mount_rpy_rad[i] = c.mount_rpy_deg[i] * kRadPerDeg;
  out.delay_s = 0.5e-9 * static_cast<double>(camera.exposure_ns);
  if (!c.attitude_file.empty()) out.record = drivers::read_attitude_csv(c.attitude_file);
  return out;
}

// Describes which part of the camera's motion is removed, and which part cannot be.
std::string camera_correction(const AppConfig& config, const core::CameraModel& camera) {
  if (config.method == Method::kPaper) return "scale per frame, two points (Eq. 6)";
  const std::string scale = "scale per frame, least squares over all points";
  const bool rests = std::any_of(config.regions.begin(), config.regions.end(),
                                 [](const auto& r) { return !core::makes_channel(r.role); });
  const bool witnessed = rests && config.spectrum.witness;
  const bool told = !config.camera.attitude_file.empty() || !config.camera.attitude_channel.empty();
  const bool shown = core::tells_camera_motion(config.regions, camera);
  const core::CameraFollowing following = core::following_with(config.scale.following, told);
  if (following == core::CameraFollowing::kSlow && witnessed && shown) {
    return fmt::format(
        "camera rotation slower than {:g} Hz, from a static region; {}; what that region still shows is taken out of "
        "the modes",
        core::SlowRotation::kSlow_hz, scale);
  }
  if (following != core::CameraFollowing::kWhole) {
    return witnessed
               ? scale + "; the part of a mode shape that is coherent with a static region is removed as camera motion"
               : scale;
  }
  if (told && !shown) {
    return "camera motion per frame from all points and a measured attitude: distance, rotation; "
           "translation along the channels' axes remains";
  }
  if (!shown) {
    return scale + (camera.calibrated()
                        ? "; no static region (role background or ground): the camera's rotation remains"
                        : "; no focal length is known: the camera's rotation remains");
  }
  const bool ground = std::any_of(config.regions.begin(), config.regions.end(),
                                  [](const auto& r) { return r.role == core::RegionRole::kGround; });
  return std::string("camera motion per frame from all points: distance, roll, perspective; ") +
         (ground ? "translation and rotation together, from static points in the structure's plane"
                 : "yaw and pitch from the background, translation as far as its distance is known");
}

}  // namespace

core::StructureTrackerConfig tracker_config(const AppConfig& config) {
  const TrackingConfig& t = config.tracking;
  core::StructureTrackerConfig tracker;
  tracker.regions = config.regions;
  tracker.min_points = t.min_points;
  tracker.seed = {t.points_per_region, t.min_distance_px, t.corner_quality, t.window_px};
  tracker.klt = {t.window_px, t.max_iterations, t.reach_px, t.least_correlation};
  tracker.search_px = t.search_px;
  tracker.reseed_after = t.reseed_after;
  return tracker;
}

core::ChannelDisplacementConfig displacement_config(const AppConfig& config, const core::CameraInfo& camera) {
  core::ChannelDisplacementConfig out;
  out.regions = config.regions;
  out.camera = camera_model(config, camera);
  out.readout = {static_cast<double>(camera.readout_ns) * 1e-9, camera.readout_direction, camera.width_px,
                 camera.height_px};
  out.rate_hz = camera.rate_hz;
  StructureScale scale = structure_scale(config, out.camera);
  out.scale_mm_per_px = scale.mm_per_px;
  if (config.method != Method::kPaper) {
    out.region_scale_mm_per_px = std::move(scale.region_mm_per_px);
    out.plane = std::move(scale.plane);
  }
  out.adaptive_scale = config.scale.adaptive;
  out.following = config.scale.following;
  out.witness = config.spectrum.witness;
  out.paper_method = config.method == Method::kPaper;
  out.shutter_velocity = config.paper.velocity;
  out.attitude = attitude_config(config, camera);
  out.inlier_sigma_px = config.tracking.inlier_sigma_px;
  out.min_points = config.tracking.min_points;
  return out;
}

core::MotorLines motor_lines(const AppConfig& config) {
  if (config.camera.motors_file.empty()) return {};
  return core::MotorLines(drivers::read_motors_csv(config.camera.motors_file));
}

// Of a spectrum: segments are padded to twice their length.
static double n_bins_of(const core::WelchConfig& welch) noexcept {
  return 1.0 + std::bit_ceil(static_cast<unsigned>(welch.segment));
}

// As many as 4 MB hold, at most 64; fewer than the search for steady lines needs are not kept.
static int kept_segments(const core::WelchConfig& welch) noexcept {
  constexpr double kMostBytes = 4e6, kMost = 64.0;
  const double n = std::min(kMost, kMostBytes / (n_bins_of(welch) * welch.n_channels * sizeof(std::complex<float>)));
  return n < core::kLeastLineSegments ? 0 : static_cast<int>(n);
}

core::WelchConfig welch_config(const SpectrumConfig& spectrum, std::size_t n_channels, double rate_hz,
                               std::size_t n_witnesses) {
  const core::WindowKind window = core::window_kind(spectrum.window).value_or(core::WindowKind::kHann);
  core::WelchConfig out;
  out.n_channels = static_cast<int>(n_channels), out.n_witnesses = static_cast<int>(n_witnesses);
  out.segment = spectrum.segment, out.overlap = spectrum.overlap, out.window = window, out.rate_hz = rate_hz;
  out.bridge_losses = true;
  out.gate_outliers = true;
  out.forget_s = spectrum.forget_s;
  out.n_kept_segments = kept_segments(out);
  require_memory(out, spectra_bytes(out), drivers::memory_left());
  return out;
}

double spectra_bytes(const core::WelchConfig& welch) noexcept {
  constexpr double kCopies = 2.0;  // at least: the sums, and those that the identification works on
  const double n_pairs = 0.5 * welch.n_channels * (welch.n_channels + 1.0);
  constexpr double kBytes = 2.0 * sizeof(std::complex<double>);  // data and mask
  return kCopies * (1.0 + welch.n_blocks) * n_bins_of(welch) * n_pairs * kBytes;
}

void require_memory(const core::WelchConfig& welch, double needed_bytes, std::uint64_t left_bytes) {
  if (needed_bytes < static_cast<double>(left_bytes)) return;
  throw ConfigError(fmt::format(
      "spectrum.segment: {} is refused: the spectra of {} channels would take {:.1f} GB, and {:.1f} GB of memory are "
      "left; shorten the segment, or use fewer channels",
      welch.segment, welch.n_channels, 1e-9 * needed_bytes, 1e-9 * static_cast<double>(left_bytes)));
}

void require_searchable(double max_frequency_hz, double rate_hz) {
  if (max_frequency_hz <= kMostFolds * rate_hz / 2.0) return;
  throw ConfigError(fmt::format(
      "identification.max_frequency_hz: {:g} is refused: allowed 0 .. {:g}, {} times half of {:g} frames a second, "
      "because every estimate weighs all frequencies that fold; lower it to the highest mode that can be",
      max_frequency_hz, kMostFolds * rate_hz / 2.0, kMostFolds, rate_hz));
}

core::IdentifierConfig identifier_config(const AppConfig& config, const std::vector<core::ChannelInfo>& channels,
                                         double rate_hz) {
  const IdentificationConfig& i = config.identification;
  core::IdentifierConfig out;
  for (const std::string& name : i.references) {
    const auto found = std::find_if(channels.begin(), channels.end(), [&](const auto& c) { return c.name == name; });
    if (found == channels.end())
      throw ConfigError(fmt::format("identification.references: '{}' is not a channel", name));
    out.references.push_back(static_cast<int>(found - channels.begin()));
  }
  out.block_rows = i.block_rows;
  out.max_order = i.max_order;
  out.min_mpc = i.min_mpc;
  out.max_damping = i.max_damping;
  out.undo_row_delays = config.method == Method::kHovermodal;
  out.as_published = config.method == Method::kPaper;
  require_searchable(i.max_frequency_hz, rate_hz);
  out.max_frequency_hz = out.undo_row_delays ? i.max_frequency_hz : rate_hz / 2.0;
  return out;
}

std::vector<std::string> region_names(const AppConfig& config) {
  std::vector<std::string> names;
  for (const core::Region& region : config.regions) names.push_back(region.name);
  return names;
}

std::vector<std::string> corrections(const AppConfig& config, const core::CameraInfo& camera) {
  std::vector<std::string> list;
  const bool paper = config.method == Method::kPaper;
  if (undistorts(config.calibration)) list.emplace_back("lens distortion (points undistorted)");
  if (config.scale.adaptive) list.push_back(camera_correction(config, camera_model(config, camera)));
  if (paper) {
    list.push_back(
        fmt::format("rolling shutter by {} velocity from frame to frame, readout = one frame (Eqs. 7-8)",
                    config.paper.velocity == core::ShutterVelocity::kCamera ? "the camera's" : "each region's"));
  } else if (camera.readout_ns != 0) {
    list.push_back(fmt::format("rolling shutter {} ms: row delays undone at each mode",
                               static_cast<double>(camera.readout_ns) * 1e-6));
  }
  return list;
}

std::vector<std::string> caveats(const AppConfig& config, const core::CameraInfo& camera) {
  std::vector<std::string> out = structure_scale(config, camera_model(config, camera)).notes;
  for (std::string& words : axis_caveats(config)) out.push_back(std::move(words));
  return out;
}

}  // namespace app
