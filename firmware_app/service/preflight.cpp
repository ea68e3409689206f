#include "firmware_app/service/preflight.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>

#include "core/planning/noise_floor.h"
#include "firmware_app/config/calibration.h"
#include "firmware_app/config/config_timing.h"
#include "firmware_app/config/region_axis.h"
#include "firmware_app/config/structure_scale.h"
#include "firmware_app/report/recording_words.h"

namespace app {
namespace {

constexpr std::size_t kMostFrames = 25;
constexpr double kSeen = 0.9;       // of the frames tried
constexpr double kFaint_px = 0.15;  // a point less certain than this has little texture
constexpr std::size_t kFewPoints = 6;

struct PointCheck {
  std::size_t n_seen = 0;
  double sigma_px = 0.0;  // sum
};

// Tracks the frames after the first one.
std::size_t track_frames(Source& source, std::vector<PointCheck>& points) {
  core::Frame frame = source.first_frame;
  core::TrackFrame tracks = source.keyframe;
  const auto n_wanted = std::min(kMostFrames, static_cast<std::size_t>(std::ceil(source.info.rate_hz)));
  std::size_t n_frames = 0;
  while (n_frames < n_wanted && source.camera->capture(frame, kFrameTimeout) == drivers::CaptureStatus::kFrame) {
    if (!source.tracker.track(frame, tracks)) break;
    for (std::size_t i = 0; i < points.size(); ++i) {
      core::TrackPoint& point = tracks.points[i];
      point.inlier = point.seen;
      if (point.seen) ++points[i].n_seen, points[i].sigma_px += point.sigma_px;
    }
    source.tracker.learn(tracks);
    ++n_frames;
  }
  return n_frames;
}

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Overlapping windows share their noise: a region has at most as many independent points as windows fit into it.
double expected_noise_px(const core::Region& region, const std::vector<double>& sigmas_px, int window_px) {
  double information = 0.0;
  for (const double sigma_px : sigmas_px) information += 1.0 / (sigma_px * sigma_px);
  if (!(information > 0.0)) return 0.0;
  const auto n = static_cast<double>(sigmas_px.size());
  const double independent = core::planning::independent_points(static_cast<int>(sigmas_px.size()), region.width_px,
                                                                region.height_px, window_px);
  return std::sqrt(n / (information * std::max(1.0, independent)));
}

std::string axis_cell(const core::Region& region) {
  if (!core::makes_channel(region.role)) return "-";
  return axis_words(region) + (region.axis_from == core::AxisFrom::kMotion ? ", found" : "");
}

RegionCheck check_region(const AppConfig& config, const core::TrackFrame& keyframe, std::size_t i_region,
                         const std::vector<PointCheck>& points, std::size_t n_frames) {
  RegionCheck out;
  out.name = config.regions[i_region].name;
  out.axis = axis_cell(config.regions[i_region]);
  std::vector<double> sigmas_px;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (keyframe.points[i].region != i_region) continue;
    ++out.n_seeded;
    const auto n_seen = static_cast<double>(points[i].n_seen);
    if (points[i].n_seen == 0 || n_seen < kSeen * static_cast<double>(n_frames)) continue;
    ++out.n_seen;
    sigmas_px.push_back(std::max(points[i].sigma_px / n_seen, 1e-4));
  }
  out.noise_px = expected_noise_px(config.regions[i_region], sigmas_px, config.tracking.window_px);
  out.point_sigma_px = median_of(std::move(sigmas_px));
  return out;
}

void add_facts(const Source& source, const StructureScale& scale, Preflight& out) {
  out.facts.push_back(scale.known ? fmt::format("scale: {:.4g} mm per px", scale.mm_per_px)
                                  : "scale: no length is known, displacements are in px");
  const double frame_ms = 1e3 / source.info.rate_hz;
  if (const std::string words = recording_words(source.camera->times()); !words.empty()) {
    out.facts.push_back("times: " + words);
  } else {
    out.facts.push_back(fmt::format("times: {:.6g} frames/s", source.info.rate_hz));
  }
  const double readout_ms = 1e-6 * static_cast<double>(source.info.readout_ns);
  out.facts.push_back(readout_ms == 0.0
                          ? "readout: global shutter or not known; of a rolling shutter it is needed for what lies "
                            "above half the frame rate"
                          : fmt::format("readout: {:.4g} ms of a frame of {:.4g} ms", readout_ms, frame_ms));
  const double exposure_ms = 1e-6 * static_cast<double>(source.info.exposure_ns);
  out.facts.push_back(exposure_ms == 0.0
                          ? std::string("exposure: not known")
                          : fmt::format("exposure: {:.4g} ms of a frame of {:.4g} ms", exposure_ms, frame_ms));
}

void warn_of_regions(Preflight& out) {
  for (const RegionCheck& region : out.regions) {
    if (region.n_seen < std::min(kFewPoints, region.n_seeded)) {
      out.warnings.push_back(
          fmt::format("region {}: only {} of {} points are found again in the first frames: it moves "
                      "too fast, is covered, or its texture is faint",
                      region.name, region.n_seen, region.n_seeded));
    } else if (region.point_sigma_px > kFaint_px) {
      out.warnings.push_back(
          fmt::format("region {}: faint texture: a point is known to {:.2g} px only; a larger "
                      "region, or one with more contrast, is better",
                      region.name, region.point_sigma_px));
    }
  }
}

}  // namespace

Preflight preflight(const AppConfig& config, Source& source) {
  Preflight out;
  std::vector<PointCheck> points(source.keyframe.points.size());
  const std::size_t n_frames = track_frames(source, points);
  const StructureScale scale = structure_scale(config, camera_model(config, source.info));
  for (std::size_t i = 0; i < config.regions.size(); ++i) {
    out.regions.push_back(check_region(config, source.keyframe, i, points, n_frames));
    if (scale.known) out.regions.back().mm_per_px = scale.region_mm_per_px[i];
  }
  add_facts(source, scale, out);
  out.warnings = doubtful_values(config, source.info.rate_hz, source.camera->times().stated_hz,
                                 scale.known ? scale.mm_per_px : 0.0);
  warn_of_regions(out);
  for (std::string& words : axis_caveats(config)) out.warnings.push_back(std::move(words));
  return out;
}

std::string preflight_text(const Preflight& found) {
  std::string out = fmt::format("{:<16} {:>10} {:>10} {:>12} {:>12} {:>14}\n", "region", "axis", "points",
                                "a point, px", "mm per px", "noise expected");
  for (const RegionCheck& region : found.regions) {
    const bool has_scale = region.mm_per_px > 0.0;
    out += fmt::format("{:<16} {:>10} {:>10} {:>12} {:>12} {:>14}\n", region.name, region.axis,
                       fmt::format("{} of {}", region.n_seen, region.n_seeded),
                       region.n_seen > 0 ? fmt::format("{:.3f}", region.point_sigma_px) : "-",
                       has_scale ? fmt::format("{:.4g}", region.mm_per_px) : "-",
                       region.n_seen == 0 ? std::string("-")
                       : has_scale        ? fmt::format("{:.2g} mm", region.noise_px * region.mm_per_px)
                                          : fmt::format("{:.2g} px", region.noise_px));
  }
  for (const std::string& fact : found.facts) out += fact + "\n";
  for (const std::string& warning : found.warnings) out += "warning: " + warning + "\n";
  return out;
}

}  // namespace app
