#include "core/geometry/scale_factor.h"

#include <algorithm>
#include <cmath>

namespace core {

namespace {

constexpr std::size_t kFarthestPairs = 64;
constexpr double kLeastPairPx = 4.0;

Vector2 minus(const Vector2& a, const Vector2& b) noexcept { return {a.u - b.u, a.v - b.v}; }
double dot(const Vector2& a, const Vector2& b) noexcept { return a.u * b.u + a.v * b.v; }

}  // namespace

ScaleFactor::ScaleFactor(std::vector<Point> points) : points_(std::move(points)) {
  for (const Point& point : points_) n_regions_ = std::max<std::size_t>(n_regions_, point.region + std::size_t{1});
  centre_now_.resize(n_regions_);
  centre_keyframe_.resize(n_regions_);
  count_.resize(n_regions_);
  list_farthest_pairs();
  list_motion_free_pairs();
  ratios_.reserve(motion_free_.size());
}

void ScaleFactor::list_farthest_pairs() {
  std::vector<Pair> all;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    for (std::size_t j = i + 1; j < points_.size(); ++j) {
      if (!points_[i].counts || !points_[j].counts) continue;
      all.push_back({i, j, {}, length(minus(points_[j].keyframe, points_[i].keyframe))});
    }
  }
  const std::size_t n = std::min(kFarthestPairs, all.size());
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(n), all.end(),
                    [](const Pair& a, const Pair& b) {
                      return a.distance_px > b.distance_px ||
                             (a.distance_px == b.distance_px && (a.i < b.i || (a.i == b.i && a.j < b.j)));
                    });
  farthest_.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(n));
}

// Pairs each point with its farthest partner in the same region, and with its farthest one across the axis of motion.
void ScaleFactor::list_motion_free_pairs() {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    Pair within{i, i, {}, kLeastPairPx};
    Pair across{i, i, {}, kLeastPairPx};
    for (std::size_t j = 0; j < points_.size(); ++j) {
      if (!points_[i].counts || !points_[j].counts) continue;
      const Vector2 step = minus(points_[j].keyframe, points_[i].keyframe);
      if (points_[j].region == points_[i].region) {
        if (length(step) > within.distance_px)
          within = {i, j, {step.u / length(step), step.v / length(step)}, length(step)};
        continue;
      }
      const bool parallel =
          std::abs(points_[i].axis_u * points_[j].axis_v - points_[i].axis_v * points_[j].axis_u) < 1e-6;
      if (points_[i].both_axes || points_[j].both_axes || !parallel) continue;
      const Vector2 normal{-points_[i].axis_v, points_[i].axis_u};
      const double d = dot(step, normal);
      if (std::abs(d) > across.distance_px)
        across = {i, j, {d > 0 ? normal.u : -normal.u, d > 0 ? normal.v : -normal.v}, std::abs(d)};
    }
    if (within.j != i) motion_free_.push_back(within);
    if (across.j != i) motion_free_.push_back(across);
  }
}

bool ScaleFactor::magnification(const Pair& pair, std::span<const Vector2> position,
                                std::span<const std::uint8_t> usable, double& b) const noexcept {
  if (usable[pair.i] == 0 || usable[pair.j] == 0) return false;
  const Vector2 step = minus(position[pair.j], position[pair.i]);
  const bool plain = pair.direction.u == 0.0 && pair.direction.v == 0.0;
  b = (plain ? length(step) : dot(step, pair.direction)) / pair.distance_px;
  return std::isfinite(b) && b > 0.0;
}

double ScaleFactor::two_point(std::span<const Vector2> position, std::span<const std::uint8_t> usable) noexcept {
  for (const Pair& pair : farthest_) {
    double b = 1.0;
    if (magnification(pair, position, usable, b)) {
      last_ = b;
      break;
    }
  }
  return last_;
}

double ScaleFactor::median_of_pairs(std::span<const Vector2> position, std::span<const std::uint8_t> usable) noexcept {
  ratios_.clear();
  for (const Pair& pair : motion_free_) {
    double b = 1.0;
    if (magnification(pair, position, usable, b)) ratios_.push_back(b);
  }
  if (ratios_.empty()) return last_;
  const auto middle = ratios_.begin() + static_cast<std::ptrdiff_t>(ratios_.size() / 2);
  std::nth_element(ratios_.begin(), middle, ratios_.end());
  return *middle;
}

double ScaleFactor::least_squares(std::span<const Vector2> position, std::span<const std::uint8_t> usable) noexcept {
  std::fill(centre_now_.begin(), centre_now_.end(), Vector2{});
  std::fill(centre_keyframe_.begin(), centre_keyframe_.end(), Vector2{});
  std::fill(count_.begin(), count_.end(), 0.0);
  double across_now = 0.0, across_keyframe = 0.0, across_count = 0.0;
  const auto normal_part = [](const Point& p, const Vector2& x) { return -p.axis_v * x.u + p.axis_u * x.v; };
  const auto counts_across = [&](const Point& p) {  // only regions with the same axis as the first
    return !p.both_axes && std::abs(p.axis_u * points_.front().axis_v - p.axis_v * points_.front().axis_u) < 1e-6;
  };
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (usable[i] == 0 || !points_[i].counts) continue;
    const Point& p = points_[i];
    centre_now_[p.region].u += position[i].u;
    centre_now_[p.region].v += position[i].v;
    centre_keyframe_[p.region].u += p.keyframe.u;
    centre_keyframe_[p.region].v += p.keyframe.v;
    count_[p.region] += 1.0;
    if (!counts_across(p)) continue;
    across_now += normal_part(points_.front(), position[i]);
    across_keyframe += normal_part(points_.front(), p.keyframe);
    across_count += 1.0;
  }
  double numerator = 0.0, denominator = 0.0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (usable[i] == 0 || !points_[i].counts) continue;
    const Point& p = points_[i];
    const double n = count_[p.region];
    const Vector2 now = minus(position[i], {centre_now_[p.region].u / n, centre_now_[p.region].v / n});
    const Vector2 key = minus(p.keyframe, {centre_keyframe_[p.region].u / n, centre_keyframe_[p.region].v / n});
    if (!counts_across(p)) {
      numerator += dot(now, key);
      denominator += dot(key, key);
      continue;
    }
    const Vector2 axis{points_.front().axis_u, points_.front().axis_v};
    const double across_key = normal_part(points_.front(), p.keyframe) - across_keyframe / across_count;
    numerator += dot(now, axis) * dot(key, axis);
    numerator += (normal_part(points_.front(), position[i]) - across_now / across_count) * across_key;
    denominator += dot(key, axis) * dot(key, axis) + across_key * across_key;
  }
  if (denominator > 0.0 && numerator > 0.0) last_ = numerator / denominator;
  return last_;
}

}  // namespace core
