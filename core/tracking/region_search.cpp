#include "core/tracking/region_search.h"

#include <algorithm>
#include <cmath>

namespace core {

namespace {

constexpr int kMargin_px = 12;            // margin about the points, for their windows
constexpr int kLeastCells = 100;          // of the coarsest image: with fewer cells places are hard to distinguish
constexpr std::size_t kMostCells = 4000;  // of a finer image: with more it is skipped, as the coarser result suffices
constexpr int kRefine = 3;                // search radius in cells about the result of the coarser image
constexpr double kLeastCorrelation = 0.6;
constexpr double kLeastVariance = 1.0;  // grey^2: a constant image has no correlation
constexpr double kNearlyAsGood = 0.3;   // below the highest correlation: still searched in finer images
constexpr double kAsGood = 0.03;        // in the finest image: treated as equally good
constexpr double kClearlyNearer = 0.7;  // of the distance of the next-nearest place
constexpr int kNeighbourhood = 2;       // cells about a peak that belong to it

}  // namespace

RegionSearch::RegionSearch(const GrayView& keyframe, const std::vector<Vector2>& points, double reach_px) {
  if (points.empty()) return;
  double left = points[0].u, right = left, top = points[0].v, bottom = top;
  for (const Vector2& p : points) {
    left = std::min(left, p.u), right = std::max(right, p.u);
    top = std::min(top, p.v), bottom = std::max(bottom, p.v);
  }
  const auto within = [](double x, int n) { return std::clamp(static_cast<int>(std::lround(x)), 0, n); };
  left_ = within(left - kMargin_px, keyframe.width), top_ = within(top - kMargin_px, keyframe.height);
  const int width = within(right + kMargin_px + 1, keyframe.width) - left_;
  const int height = within(bottom + kMargin_px + 1, keyframe.height) - top_;
  while (first_ + 2 < kScales.size() && width * height < kLeastCells * kScales[first_] * kScales[first_]) ++first_;
  for (std::size_t s = first_; s < kScales.size(); ++s) {
    const int scale = kScales[s];
    const int around = s == first_ ? static_cast<int>(std::ceil(reach_px / scale)) : kRefine;
    Picture& pattern = patterns_[s];
    pattern.scale = scale, pattern.width = width / scale, pattern.height = height / scale;
    pattern.cells.resize(static_cast<std::size_t>(pattern.width * pattern.height));
    reduce(keyframe, left_, top_, pattern);
    Picture& area = areas_[s];
    area.scale = scale, area.width = pattern.width + 2 * around, area.height = pattern.height + 2 * around;
    area.cells.resize(static_cast<std::size_t>(area.width * area.height));
    const auto n_offsets = static_cast<std::size_t>((2 * around + 1) * (2 * around + 1));
    correlations_.resize(std::max(correlations_.size(), n_offsets));
  }
}

// Beyond the border the last pixel is repeated: a constant, which correlates with nothing.
void RegionSearch::reduce(const GrayView& gray, int left, int top, Picture& out) noexcept {
  const int s = out.scale;
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      int sum = 0;
      for (int dy = 0; dy < s; ++dy) {
        const std::uint8_t* row = gray.row(std::clamp(top + y * s + dy, 0, gray.height - 1));
        const int first = left + x * s;
        if (first >= 0 && first + s <= gray.width) {
          for (int dx = 0; dx < s; ++dx) sum += row[first + dx];
        } else {
          for (int dx = 0; dx < s; ++dx) sum += row[std::clamp(first + dx, 0, gray.width - 1)];
        }
      }
      out.cells[static_cast<std::size_t>(y * out.width + x)] = static_cast<float>(sum) / static_cast<float>(s * s);
    }
  }
}

void RegionSearch::correlate(const Picture& pattern, const Picture& area) noexcept {
  const auto n = static_cast<double>(pattern.cells.size());
  double mean = 0.0, square = 0.0;
  for (const float cell : pattern.cells) {
    const auto value = static_cast<double>(cell);
    mean += value / n, square += value * value / n;
  }
  const double variance = square - mean * mean;
  n_u_ = area.width - pattern.width + 1, n_v_ = area.height - pattern.height + 1;
  for (int v = 0; v < n_v_; ++v) {
    for (int u = 0; u < n_u_; ++u) {
      double sum = 0.0, squares = 0.0, both = 0.0;
      for (int y = 0; y < pattern.height; ++y) {
        const float* a = area.cells.data() + (v + y) * area.width + u;
        const float* p = pattern.cells.data() + y * pattern.width;
        for (int x = 0; x < pattern.width; ++x) {
          const auto value = static_cast<double>(a[x]);
          sum += value, squares += value * value, both += value * static_cast<double>(p[x]);
        }
      }
      const double area_mean = sum / n, area_variance = squares / n - area_mean * area_mean;
      correlations_[static_cast<std::size_t>(v * n_u_ + u)] =
          area_variance > kLeastVariance && variance > kLeastVariance
              ? (both / n - area_mean * mean) / std::sqrt(area_variance * variance)
              : -1.0;
    }
  }
}

// Lists local maxima of the correlation that are nearly as high as the highest, the highest first.
void RegionSearch::list_peaks(const Place& about) noexcept {
  const auto is_peak = [&](int u, int v) {
    for (int y = std::max(0, v - kNeighbourhood); y <= std::min(n_v_ - 1, v + kNeighbourhood); ++y)
      for (int x = std::max(0, u - kNeighbourhood); x <= std::min(n_u_ - 1, u + kNeighbourhood); ++x)
        if (at(x, y) > at(u, v)) return false;
    return true;
  };
  double highest = -1.0;
  for (int v = 0; v < n_v_; ++v)
    for (int u = 0; u < n_u_; ++u) highest = std::max(highest, at(u, v));
  n_places_ = 0;
  const int scale = kScales[first_];
  for (int v = 0; v < n_v_; ++v) {
    for (int u = 0; u < n_u_; ++u) {
      if (at(u, v) < highest - kNearlyAsGood || at(u, v) <= 0.0 || !is_peak(u, v)) continue;
      const Place place{about.du + (u - n_u_ / 2) * scale, about.dv + (v - n_v_ / 2) * scale, at(u, v)};
      if (n_places_ < kMostPlaces) {
        places_[n_places_++] = place;
        continue;
      }
      Place& worst = *std::min_element(places_.begin(), places_.end(),
                                       [](const Place& a, const Place& b) { return a.correlation < b.correlation; });
      if (place.correlation > worst.correlation) worst = place;
    }
  }
}

RegionSearch::Place RegionSearch::refine(const GrayView& gray, Place place) noexcept {
  for (std::size_t s = first_ + 1; s < kScales.size() && patterns_[s].cells.size() <= kMostCells; ++s) {
    Picture& area = areas_[s];
    reduce(gray, left_ + place.du - kRefine * area.scale, top_ + place.dv - kRefine * area.scale, area);
    correlate(patterns_[s], area);
    Place best{place.du, place.dv, -1.0};
    for (int v = 0; v < n_v_; ++v)
      for (int u = 0; u < n_u_; ++u)
        if (at(u, v) > best.correlation)
          best = {place.du + (u - kRefine) * area.scale, place.dv + (v - kRefine) * area.scale, at(u, v)};
    place = best;
  }
  return place;
}

RegionSearch::Found RegionSearch::choose(const Vector2& expected_motion) const noexcept {
  double highest = -1.0, nearest = HUGE_VAL, next = HUGE_VAL;
  for (std::size_t i = 0; i < n_places_; ++i) highest = std::max(highest, places_[i].correlation);
  Found found{expected_motion, 0.0, false};
  for (std::size_t i = 0; i < n_places_; ++i) {
    const Place& place = places_[i];
    if (place.correlation < highest - kAsGood) continue;
    const double distance = length(place.du - expected_motion.u, place.dv - expected_motion.v);
    if (distance < nearest) {
      next = nearest, nearest = distance;
      found.motion = {static_cast<double>(place.du), static_cast<double>(place.dv)};
      found.correlation = place.correlation;
    } else {
      next = std::min(next, distance);
    }
  }
  found.is_clear = found.correlation > kLeastCorrelation && nearest <= kClearlyNearer * next;
  return found;
}

RegionSearch::Found RegionSearch::find(const GrayView& gray, const Vector2& expected_motion) noexcept {
  const Found nothing{expected_motion, 0.0, false};
  constexpr double kFar_px = 1e5;
  if (gray.empty() || patterns_[first_].cells.empty()) return nothing;
  if (!(std::abs(expected_motion.u) < kFar_px) || !(std::abs(expected_motion.v) < kFar_px)) return nothing;
  const Place about{static_cast<int>(std::lround(expected_motion.u)), static_cast<int>(std::lround(expected_motion.v)),
                    0};
  const Picture& pattern = patterns_[first_];
  Picture& area = areas_[first_];
  const int around = (area.width - pattern.width) / 2;
  reduce(gray, left_ + about.du - around * area.scale, top_ + about.dv - around * area.scale, area);
  correlate(pattern, area);
  list_peaks(about);
  for (std::size_t i = 0; i < n_places_; ++i) places_[i] = refine(gray, places_[i]);
  return choose(expected_motion);
}

}  // namespace core
