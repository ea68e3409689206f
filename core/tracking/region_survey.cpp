#include "core/tracking/region_survey.h"

#include <algorithm>
#include <map>
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

// Interpolates linearly between two frames in which the point was found.
void interpolate(std::vector<Vector2>& motion, const std::vector<std::size_t>& seen) {
  for (std::size_t k = 1; k < seen.size(); ++k) {
    const std::size_t from = seen[k - 1], to = seen[k];
    for (std::size_t t = from + 1; t < to; ++t) {
      const double share = static_cast<double>(t - from) / static_cast<double>(to - from);
      motion[t] = {motion[from].u + share * (motion[to].u - motion[from].u),
                   motion[from].v + share * (motion[to].v - motion[from].v)};
    }
  }
}

}  // namespace

RegionSurvey::RegionSurvey(const GrayView& first, const RegionSurveyConfig& config)
    : config_(config), tracker_(config.klt) {
  std::vector<Vector2> corners;
  if (!first.empty()) {
    // OpenCV takes external pixels as non-const; they are not written here.
    const cv::Mat image(first.height, first.width, CV_8UC1, const_cast<std::uint8_t*>(first.pixels), first.stride);
    corners = corners_of(image, config);
  }
  tracker_.set_keyframe(first, corners);
  for (const Vector2& at : corners) points_.push_back({at, 0.0, {Vector2{}}});
  seen_.assign(points_.size(), {0});
  if (!points_.empty()) make_patches(first);
}

void RegionSurvey::make_patches(const GrayView& first) {
  const int n_across = first.width / config_.patch_px + 1;
  std::map<int, std::vector<std::size_t>> members;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const int column = static_cast<int>(points_[i].at.u) / config_.patch_px;
    const int row = static_cast<int>(points_[i].at.v) / config_.patch_px;
    members[row * n_across + column].push_back(i);
  }
  patch_of_.assign(points_.size(), 0);
  for (auto& [place, own] : members) {
    std::vector<Vector2> corners;
    for (const std::size_t i : own) corners.push_back(points_[i].at), patch_of_[i] = patches_.size();
    patches_.push_back({std::move(own), RegionSearch(first, corners, config_.search_px), {}});
  }
}

bool RegionSurvey::find_at(const GrayView& frame, std::size_t i, const Vector2& motion) {
  SurveyedPoint& point = points_[i];
  const KltPoint found = tracker_.find(frame, i, {point.at.u + motion.u, point.at.v + motion.v});
  if (!found.seen) return false;
  point.sigma_px += found.sigma_px;
  point.motion.back() = {found.position.u - point.at.u, found.position.v - point.at.v};
  seen_[i].push_back(n_frames_ - 1);
  return true;
}

void RegionSurvey::add(const GrayView& frame) {
  ++n_frames_;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    std::vector<Vector2>& motion = points_[i].motion;
    const Vector2 last = motion.back();
    const Vector2 before = motion.size() > 1 ? motion[motion.size() - 2] : last;
    motion.push_back(last);
    if (!find_at(frame, i, last)) (void)find_at(frame, i, {2.0 * last.u - before.u, 2.0 * last.v - before.v});
  }
  search_patches(frame);
  follow_neighbours(frame);
}

void RegionSurvey::search_patches(const GrayView& frame) {
  constexpr std::size_t kFewest = 4;  // points per pattern
  for (Patch& patch : patches_) {
    std::vector<std::size_t> lost;
    for (const std::size_t i : patch.members) {
      if (is_seen(i)) continue;
      lost.push_back(i);
    }
    if (patch.members.size() >= kFewest && 2 * lost.size() > patch.members.size()) {
      const RegionSearch::Found found = patch.search.find(frame, patch.motion);
      if (found.is_clear) {
        for (const std::size_t i : lost) (void)find_at(frame, i, found.motion);
      }
    }
    Vector2 sum;
    double n = 0.0;
    for (const std::size_t i : patch.members) {
      if (!is_seen(i)) continue;
      sum.u += points_[i].motion.back().u, sum.v += points_[i].motion.back().v, n += 1.0;
    }
    if (n > 0.0) patch.motion = {sum.u / n, sum.v / n};
  }
}

// Predicts lost points from the nearest points that were found.
void RegionSurvey::follow_neighbours(const GrayView& frame) {
  constexpr std::size_t kAsked = 3;
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (is_seen(i)) found.push_back(i);
  }
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (is_seen(i)) continue;
    near.clear();
    for (const std::size_t k : found) {
      const double du = points_[k].at.u - points_[i].at.u, dv = points_[k].at.v - points_[i].at.v;
      near.emplace_back(du * du + dv * dv, k);
    }
    const std::size_t n = std::min(kAsked, near.size());
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(n), near.end());
    for (std::size_t k = 0; k < n; ++k) {
      if (find_at(frame, i, points_[near[k].second].motion.back())) break;
    }
  }
}

std::vector<SurveyedPoint> RegionSurvey::take_points() {
  std::vector<SurveyedPoint> out;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::size_t n_seen = seen_[i].size() - 1;
    const std::size_t n_missing = n_frames_ - 1 - n_seen;
    if (n_seen == 0 || static_cast<double>(n_missing) > config_.most_missing * static_cast<double>(n_frames_ - 1))
      continue;
    points_[i].sigma_px /= static_cast<double>(n_seen);
    interpolate(points_[i].motion, seen_[i]);
    out.push_back(std::move(points_[i]));
  }
  points_.clear();
  seen_.clear();
  patches_.clear();
  return out;
}

}  // namespace core
