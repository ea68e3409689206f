#include "core/tracking/region_survey.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <utility>

#include "core/tracking/point_seeder.h"

namespace core {
namespace {

std::vector<Vector2> corners_of(const cv::Mat& image, const RegionSurveyConfig& config) {
  const SeedConfig seed{config.points_per_tile, config.min_distance_px, config.corner_quality, config.klt.window_px};
  std::vector<Vector2> out;
  for (int v = 0; v < image.rows; v += config.tile_px) {
    for (int u = 0; u < image.cols; u += config.tile_px) {
      Region tile;
      tile.u_px = u;
      tile.v_px = v;
      tile.width_px = std::min(config.tile_px, image.cols - u);
      tile.height_px = std::min(config.tile_px, image.rows - v);
      for (const cv::Point2f& corner : seed_points(image, tile, seed))
        out.push_back({static_cast<double>(corner.x), static_cast<double>(corner.y)});
    }
  }
  return out;
}

}  // namespace

RegionSurvey::RegionSurvey(const GrayView& first, const RegionSurveyConfig& config)
    : config_(config), tracker_(config.klt) {
  std::vector<Vector2> corners;
  if (!first.empty()) {
    // OpenCV takes the pixels of others as not const; nothing here writes them.
    const cv::Mat image(first.height, first.width, CV_8UC1, const_cast<std::uint8_t*>(first.pixels), first.stride);
    corners = corners_of(image, config);
  }
  tracker_.set_keyframe(first, corners);
  for (const Vector2& at : corners) points_.push_back({at, 0.0, {Vector2{}}});
  n_missing_.assign(points_.size(), 0);
}

void RegionSurvey::add(const GrayView& frame) {
  ++n_frames_;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    SurveyedPoint& point = points_[i];
    const Vector2 last = point.motion.back();
    const KltPoint found = tracker_.find(frame, i, {point.at.u + last.u, point.at.v + last.v});
    if (!found.seen) {
      ++n_missing_[i];
      point.motion.push_back(last);
      continue;
    }
    point.sigma_px += found.sigma_px;
    point.motion.push_back({found.position.u - point.at.u, found.position.v - point.at.v});
  }
}

std::vector<SurveyedPoint> RegionSurvey::take_points() {
  std::vector<SurveyedPoint> out;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::size_t n_seen = n_frames_ - 1 - n_missing_[i];
    if (n_seen == 0 || static_cast<double>(n_missing_[i]) > config_.most_missing * static_cast<double>(n_frames_ - 1))
      continue;
    points_[i].sigma_px /= static_cast<double>(n_seen);
    out.push_back(std::move(points_[i]));
  }
  points_.clear();
  n_missing_.clear();
  return out;
}

}  // namespace core
