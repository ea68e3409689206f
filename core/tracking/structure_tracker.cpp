#include "core/tracking/structure_tracker.h"

#include <algorithm>
#include <cstdio>

namespace core {

namespace {

std::string too_few_corners(const Region& region, std::size_t found, int wanted) {
  char text[320];
  std::snprintf(
      text, sizeof text,
      "region '%s' (rect [%g, %g, %g, %g]) has %zu corners to track, at least %d are needed: is it black, saturated, "
      "blurred or flat? Move or enlarge the rectangle, or lower tracking.corner_quality or tracking.min_distance_px",
      region.name.c_str(), region.u_px, region.v_px, region.width_px, region.height_px, found, wanted);
  return text;
}

}  // namespace

std::string StructureTracker::seed(const Frame& frame) {
  const GrayView gray = gray_view(frame);
  const cv::Mat image(gray.height, gray.width, CV_8UC1, const_cast<std::uint8_t*>(gray.pixels), gray.stride);
  std::vector<cv::Point2f> points;
  region_of_point_.clear();
  for (std::size_t r = 0; r < config_.regions.size(); ++r) {
    std::vector<cv::Point2f> corners = seed_points(image, config_.regions[r], config_.seed);
    std::erase_if(corners, [&](const cv::Point2f& p) {
      return !is_trackable(gray, {static_cast<double>(p.x), static_cast<double>(p.y)}, config_.klt.window_px);
    });
    if (static_cast<int>(corners.size()) < config_.min_points) {
      return too_few_corners(config_.regions[r], corners.size(), config_.min_points);
    }
    points.insert(points.end(), corners.begin(), corners.end());
    region_of_point_.insert(region_of_point_.end(), corners.size(), static_cast<std::uint16_t>(r));
  }
  begin(frame, points);
  return {};
}

void StructureTracker::set_keyframe(const Frame& image, const TrackFrame& keyframe) {
  std::vector<cv::Point2f> points;
  region_of_point_.clear();
  for (const TrackPoint& point : keyframe.points) {
    points.emplace_back(static_cast<float>(point.u_px), static_cast<float>(point.v_px));
    region_of_point_.push_back(point.region);
  }
  begin(image, points);
}

void StructureTracker::begin(const Frame& frame, const std::vector<cv::Point2f>& points) {
  std::vector<Vector2> keyframe;
  for (const cv::Point2f& point : points)
    keyframe.push_back({static_cast<double>(point.x), static_cast<double>(point.y)});
  n_lost_.assign(points.size(), 0);
  finder_ = std::make_unique<PointFinder>(
      PointFinderConfig{config_.klt, config_.min_points, config_.search_px, config_.reseed_after}, gray_view(frame),
      keyframe, region_of_point_, config_.regions.size());
  follower_ = std::make_unique<RegionFollower>(
      RegionFollowerConfig{frame.width_px, frame.height_px, config_.min_points, config_.lost_after}, keyframe,
      region_of_point_, config_.regions.size());
}

bool StructureTracker::track(const Frame& frame, TrackFrame& out) noexcept {
  out.sequence = frame.sequence;
  out.t_start_ns = frame.t_start_ns;
  out.gap_before = frame.gap_before;
  const std::vector<KltPoint>& found = finder_->points();
  const GrayView gray = gray_view(frame);
  const bool is_image = !gray.empty();
  if (is_image) finder_->find(gray, *follower_);
  for (std::size_t i = 0; i < out.points.size() && i < found.size(); ++i) {
    TrackPoint& point = out.points[i];
    point.id = static_cast<std::uint32_t>(i);
    point.region = region_of_point_[i];
    point.u_px = found[i].position.u;
    point.v_px = found[i].position.v;
    point.sigma_px = found[i].sigma_px;
    point.seen = is_image && found[i].seen;
    point.inlier = false;
  }
  return is_image;
}

void StructureTracker::learn(const TrackFrame& judged) noexcept {
  follower_->update(judged);
  finder_->learn(judged);
  for (std::size_t i = 0; i < n_lost_.size() && i < judged.points.size(); ++i)
    n_lost_[i] = judged.points[i].inlier ? 0 : std::min(n_lost_[i] + 1, kLostForGood);
}

PointLosses StructureTracker::losses() const noexcept {
  PointLosses out;
  for (std::size_t i = 0; i < n_lost_.size(); ++i) {
    if (n_lost_[i] < kLostForGood) continue;
    const KltPoint& point = finder_->points()[i];
    const bool has_left = !point.seen && point.loss == PointLoss::kLeftImage;
    const bool is_dark = !point.seen && point.loss == PointLoss::kLight;
    ++(has_left ? out.left_image : is_dark ? out.light : point.seen ? out.elsewhere : out.unlike);
  }
  return out;
}

}  // namespace core
