#include "core/tracking/point_reseeder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/tracking/similarity.h"

namespace core {

namespace {

constexpr int kMostMissed = PointReseeder::kTrialFrames / 5;
constexpr double kMostScatter = 2.0;     // relative to that of the region's points plus the point's own sigma
constexpr double kMostVariance = 4.0;    // position variance of a new template, in multiples of that of the first one
constexpr int kPointsOfSimilarity = 4;   // with fewer points only a translation is estimated
constexpr double kLeastSpread_px = 5.0;  // rms distance of the region's points from their centre
constexpr int kEighths = 8;
constexpr std::array<double, 3> kRings{0.0, 0.5, 1.0};  // radii in multiples of kFarthest_px

// Number of places for a new template about its point, tried in order of distance.
constexpr int kPlaces = 1 + 2 * kEighths;
constexpr std::array<Vector2, kEighths> kDirections{
    {{1.0, 0.0}, {0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}, {0.7, 0.7}, {-0.7, 0.7}, {-0.7, -0.7}, {0.7, -0.7}}};

Vector2 beside(int place) {
  const int k = place % kPlaces;
  if (k == 0) return {};
  const double radius = PointReseeder::kFarthest_px * kRings[static_cast<std::size_t>(1 + (k - 1) / kEighths)];
  const Vector2& direction = kDirections[static_cast<std::size_t>((k - 1) % kEighths)];
  return {radius * direction.u, radius * direction.v};
}

}  // namespace

PointReseeder::PointReseeder(const KltTracker& tracker, const std::vector<Vector2>& keyframe,
                             const std::vector<std::uint16_t>& region_of_point, int after_frames, int min_points)
    : points_(keyframe.size()), after_frames_(after_frames), min_points_(std::max(1, min_points)) {
  for (std::size_t i = 0, first = 0; i < points_.size(); ++i) {
    if (region_of_point[i] != region_of_point[first]) first = i;
    points_[i].keyframe = keyframe[i];
    points_[i].most_variance_px2 = kMostVariance * place_variance(tracker.point_template(i));
    points_[i].first = first;
    for (std::size_t j = first; j <= i; ++j) points_[j].n = i - first + 1;
  }
}

int PointReseeder::judge(const GrayView& gray, std::vector<KltPoint>& found, KltTracker& tracker,
                         TemplateAverage& templates) noexcept {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!points_[i].is_on_trial) continue;
    go_on(points_[i], i, found, tracker);
    found[i].seen = false;
  }
  return after_frames_ > 0 ? begin_one(gray, found, tracker, templates) : -1;
}

void PointReseeder::learn(const TrackFrame& judged) noexcept {
  const std::size_t n = std::min(points_.size(), judged.points.size());
  for (std::size_t first = 0; first < n; first += points_[first].n) {
    const std::size_t end = std::min(n, first + points_[first].n);
    int n_inliers = 0;
    for (std::size_t i = first; i < end; ++i) n_inliers += judged.points[i].inlier ? 1 : 0;
    for (std::size_t i = first; i < end; ++i) {
      Point& point = points_[i];
      point.is_inlier = judged.points[i].inlier;
      if (point.is_inlier)
        point.n_lost = 0, point.n_places = 0;
      else if (n_inliers >= min_points_)
        point.n_lost = std::min(point.n_lost + 1, after_frames_);
    }
  }
}

// Predicts the place from the region's points that were inliers and are seen. False: too few.
bool PointReseeder::place_of(const Point& point, const std::vector<KltPoint>& found, Place& place) const noexcept {
  const auto counts = [&](std::size_t i) { return points_[i].is_inlier && found[i].seen; };
  const auto k = [&](std::size_t i) { return points_[i].keyframe; };
  const auto p = [&](std::size_t i) { return found[i].position; };
  const SimilarityMoments m = similarity_moments(point.first, point.first + point.n, counts, k, p);
  if (m.count < min_points_) return false;
  const bool turns = m.count >= kPointsOfSimilarity && m.spread > m.count * kLeastSpread_px * kLeastSpread_px;
  const double re = turns ? m.along / m.spread : 1.0, im = turns ? m.across / m.spread : 0.0;
  const Vector2 from{point.keyframe.u - m.mean_k.u, point.keyframe.v - m.mean_k.v};
  place.at = {m.mean_p.u + re * from.u - im * from.v, m.mean_p.v + im * from.u + re * from.v};
  const double left = m.squares - 2.0 * (re * m.along + im * m.across) + (re * re + im * im) * m.spread;
  place.variance_px2 = 0.5 * std::max(0.0, left) / std::max(1.0, m.count - (turns ? 2.0 : 1.0));
  return true;
}

// Processes one frame of a trial.
void PointReseeder::go_on(Point& point, std::size_t i, const std::vector<KltPoint>& found,
                          KltTracker& tracker) noexcept {
  Place place;
  if (!place_of(point, found, place)) return;
  if (!found[i].seen) {
    point.is_on_trial = ++point.n_missed <= kMostMissed;
    return;
  }
  const Vector2 off{found[i].position.u - place.at.u, found[i].position.v - place.at.v};
  point.sum = {point.sum.u + off.u, point.sum.v + off.v};
  point.squares += off.u * off.u + off.v * off.v;
  point.variances += place.variance_px2 + found[i].sigma_px * found[i].sigma_px;
  if (++point.n_found < kTrialFrames) return;
  point.is_on_trial = false;
  const Vector2 mean{point.sum.u / kTrialFrames, point.sum.v / kTrialFrames};
  const double scatter = 0.5 * (point.squares / kTrialFrames - mean.u * mean.u - mean.v * mean.v);  // px^2 per axis
  if (!(scatter < kMostScatter * kMostScatter * point.variances / kTrialFrames)) return;
  tracker.shift_datum(i, mean);
  point.n_lost = 0;
  ++n_reseeded_;
}

// Cuts a template for the next point, in turn, that needs one.
int PointReseeder::begin_one(const GrayView& gray, const std::vector<KltPoint>& found, KltTracker& tracker,
                             TemplateAverage& templates) noexcept {
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const std::size_t i = (next_ + k) % points_.size();
    Point& point = points_[i];
    Place place;
    if (point.is_on_trial || point.n_lost < after_frames_ || !place_of(point, found, place)) continue;
    next_ = i + 1;
    if (!tracker.renew(i, gray, place.at, beside(point.n_places++), point.most_variance_px2)) return -1;
    templates.forget(i);
    point.is_on_trial = true;
    point.n_found = point.n_missed = 0;
    point.sum = {};
    point.squares = point.variances = 0.0;
    return static_cast<int>(i);
  }
  return -1;
}

}  // namespace core
