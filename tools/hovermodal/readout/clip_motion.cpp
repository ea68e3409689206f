#include "tools/hovermodal/readout/clip_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/geometry/rolling_shutter.h"
#include "core/linear/median.h"
#include "core/tracking/point_seeder.h"
#include "core/tracking/pyramid_klt.h"
#include "drivers/camera/recording/frame_source.h"
#include "tools/hovermodal/clip_source.h"
#include "tools/hovermodal/simulate/progress.h"

namespace tools {
namespace {

constexpr int kAcross = 8, kDown = 6, kPerTile = 6;  // seeds
constexpr std::size_t kLeastPoints = 30, kNeighbours = 8;
constexpr double kMostApart_px = 3.0;  // of a point's motion from the median of its neighbours

std::vector<cv::Point2f> seeds(const cv::Mat& gray) {
  core::SeedConfig config;
  config.points_per_region = kPerTile;
  config.corner_quality = 0.02;
  std::vector<cv::Point2f> all;
  for (int i = 0; i < kAcross * kDown; ++i) {
    core::Region tile;
    tile.width_px = static_cast<double>(gray.cols) / kAcross;
    tile.height_px = static_cast<double>(gray.rows) / kDown;
    tile.u_px = (i % kAcross) * tile.width_px;
    tile.v_px = std::floor(static_cast<double>(i) / kAcross) * tile.height_px;
    const std::vector<cv::Point2f> found = core::seed_points(gray, tile, config);
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

struct Step {
  cv::Point2f from, to;
};

// Whether a point moves like the points around it: camera rotation moves neighbours alike.
bool goes_along(const std::vector<Step>& steps, std::size_t i) {
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t j = 0; j < steps.size(); ++j) {
    const cv::Point2f apart = steps[j].from - steps[i].from;
    if (j != i) near.emplace_back(apart.dot(apart), j);
  }
  const std::size_t n = std::min(kNeighbours, near.size());
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(n), near.end());
  std::vector<double> u, v;
  for (std::size_t k = 0; k < n; ++k) {
    const Step& other = steps[near[k].second];
    u.push_back(static_cast<double>(other.to.x - other.from.x));
    v.push_back(static_cast<double>(other.to.y - other.from.y));
  }
  return std::hypot(static_cast<double>(steps[i].to.x - steps[i].from.x) - core::median(u),
                    static_cast<double>(steps[i].to.y - steps[i].from.y) - core::median(v)) < kMostApart_px;
}

std::vector<Step> steps_between(const cv::Mat& first, const cv::Mat& second) {
  core::PyramidKlt tracker(core::PyramidKltConfig{});
  const std::vector<cv::Point2f> points = seeds(first);
  std::vector<Step> steps, kept;
  if (points.size() < kLeastPoints) return kept;
  tracker.set_keyframe(first, points);
  std::vector<core::TrackedPoint> found;
  if (!tracker.track(second, points, found)) return kept;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i].seen) steps.push_back({points[i], found[i].position});
  }
  if (steps.size() < kLeastPoints) return kept;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (goes_along(steps, i)) kept.push_back(steps[i]);
  }
  return kept;
}

core::PointPair point_pair(const Step& step, const core::CameraModel& camera, const core::ReadoutModel& readout) {
  const core::Vector2 from{static_cast<double>(step.from.x), static_cast<double>(step.from.y)};
  const core::Vector2 to{static_cast<double>(step.to.x), static_cast<double>(step.to.y)};
  return {camera.undistort(from), camera.undistort(to), readout.fraction(from.u, from.v), readout.fraction(to.u, to.v)};
}

bool inside_any(const cv::Point2f& point, const std::vector<std::array<double, 4>>& rectangles) {
  const auto u = static_cast<double>(point.x), v = static_cast<double>(point.y);
  return std::any_of(rectangles.begin(), rectangles.end(), [&](const std::array<double, 4>& r) {
    return u >= r[0] && v >= r[1] && u < r[0] + r[2] && v < r[1] + r[3];
  });
}

}  // namespace

ClipMotion track_clip(const ClipFile& file, const std::vector<double>& stamps_s, const core::CameraModel& camera,
                      core::ReadoutDirection direction, int hold_out_every,
                      const std::vector<std::array<double, 4>>& ignored, bool is_quiet) {
  drivers::silence_media_libraries();
  const auto source = open_clip(file.path, file.decoder_mb);
  ClipMotion clip{source->info().width_px, source->info().height_px, 0, {}};
  const core::ReadoutModel readout{0.0, direction, clip.width_px, clip.height_px};
  core::Frame frame;
  frame.width_px = clip.width_px;
  frame.height_px = clip.height_px;
  frame.pixels.resize(static_cast<std::size_t>(clip.width_px) * static_cast<std::size_t>(clip.height_px));
  cv::Mat last;
  Progress progress("readout", source->info().frame_count, "frames", is_quiet);
  std::size_t n = 0;
  for (; source->read(frame) == drivers::ReadStatus::kFrame; ++n) {
    if (n >= stamps_s.size())
      throw std::invalid_argument(fmt::format("readout: {} stamps for more frames than that in {}", n, file.path));
    const cv::Mat now = cv::Mat(clip.height_px, clip.width_px, CV_8UC1, frame.pixels.data()).clone();
    core::FramePair pair;
    if (n > 0) {
      pair.from_s = stamps_s[n - 1];
      pair.to_s = stamps_s[n];
      for (const Step& step : steps_between(last, now)) {
        if (!inside_any(step.from, ignored)) pair.points.push_back(point_pair(step, camera, readout));
      }
    }
    if (pair.points.size() >= kLeastPoints) clip.pairs.push_back(std::move(pair));
    last = now;
    progress.update(std::min<std::uint64_t>(n + 1, std::max<std::uint64_t>(source->info().frame_count, 1)));
  }
  clip.n_frames = n;
  if (!source->error().empty()) throw std::runtime_error(source->error());
  for (std::size_t k = 0; k < clip.pairs.size(); ++k)
    clip.pairs[k].held_out = hold_out_every > 0 && (k + 1) % static_cast<std::size_t>(hold_out_every) == 0;
  return clip;
}

}  // namespace tools
