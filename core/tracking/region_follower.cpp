#include "core/tracking/region_follower.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/tracking/similarity.h"

namespace core {

namespace {

// Limits of the magnification for a hovering camera.
constexpr double kLeastMagnification = 0.2, kMostMagnification = 5.0;

}  // namespace

RegionFollower::RegionFollower(RegionFollowerConfig config, std::vector<Vector2> keyframe,
                               std::vector<std::uint16_t> region_of_point, std::size_t n_regions)
    : config_(config),
      keyframe_(std::move(keyframe)),
      expected_(keyframe_),
      region_of_point_(std::move(region_of_point)),
      regions_(n_regions) {
  if (region_of_point_.size() != keyframe_.size())
    throw std::invalid_argument("RegionFollower: every point needs a region");
  for (const std::uint16_t r : region_of_point_) {
    if (r >= n_regions) throw std::invalid_argument("RegionFollower: a point of no region");
    ++regions_[r].n_points;
  }
}

void RegionFollower::update(const TrackFrame& judged) noexcept {
  measure_regions(judged);
  fit_common(judged);
  note_distances(judged);
  predict(judged);
  judge_states();
}

bool RegionFollower::is_measured(std::size_t region) const noexcept {
  return static_cast<int>(regions_[region].n_inliers) >= std::max(1, config_.min_points);
}

bool RegionFollower::is_used(const TrackPoint& point) const noexcept {
  return point.inlier && std::isfinite(point.u_px) && std::isfinite(point.v_px);
}

void RegionFollower::measure_regions(const TrackFrame& judged) noexcept {
  for (Watched& region : regions_) region.n_inliers = 0;
  std::size_t i = 0;
  for (const TrackPoint& point : judged.points) {
    if (i >= keyframe_.size()) break;
    if (is_used(point)) ++regions_[region_of_point_[i]].n_inliers;
    ++i;
  }
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    Watched& region = regions_[r];
    if (region.n_inliers == 0) continue;
    Vector2 sum;
    for (i = 0; i < keyframe_.size() && i < judged.points.size(); ++i) {
      if (region_of_point_[i] != r || !is_used(judged.points[i])) continue;
      sum.u += judged.points[i].u_px - keyframe_[i].u;
      sum.v += judged.points[i].v_px - keyframe_[i].v;
    }
    region.offset = {sum.u / region.n_inliers, sum.v / region.n_inliers};
  }
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    Watched& region = regions_[r];
    if (is_measured(r))
      region.prediction.update(region.offset, judged.gap_before);
    else
      region.prediction.forget();
  }
}

// Least squares of p = turn k + shift over the inliers of all measured regions. Unchanged if no region is measured.
void RegionFollower::fit_common(const TrackFrame& judged) noexcept {
  const std::size_t n = std::min(keyframe_.size(), judged.points.size());
  const auto counts = [&](std::size_t i) { return is_used(judged.points[i]) && is_measured(region_of_point_[i]); };
  const auto k = [&](std::size_t i) { return keyframe_[i]; };
  const auto p = [&](std::size_t i) { return Vector2{judged.points[i].u_px, judged.points[i].v_px}; };
  const SimilarityMoments m = similarity_moments(0, n, counts, k, p);
  if (m.count == 0.0) return;
  Similarity fit;
  const double magnification = m.spread > 0.0 ? length(m.along, m.across) / m.spread : 0.0;
  if (magnification > kLeastMagnification && magnification < kMostMagnification) {
    fit.turn_re = m.along / m.spread;
    fit.turn_im = m.across / m.spread;
  }
  const Vector2 turned = fit.of(m.mean_k);
  fit.shift = {m.mean_p.u - turned.u, m.mean_p.v - turned.v};
  common_ = fit;
}

void RegionFollower::note_distances(const TrackFrame& judged) noexcept {
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    if (!is_measured(r)) continue;
    Vector2 sum;
    for (std::size_t i = 0; i < keyframe_.size() && i < judged.points.size(); ++i) {
      if (region_of_point_[i] != r || !is_used(judged.points[i])) continue;
      const Vector2 common = common_.of(keyframe_[i]);
      sum = {sum.u + judged.points[i].u_px - common.u, sum.v + judged.points[i].v_px - common.v};
    }
    const auto count = static_cast<double>(regions_[r].n_inliers);
    regions_[r].off_common = {sum.u / count, sum.v / count};
  }
}

void RegionFollower::predict(const TrackFrame& judged) noexcept {
  for (Watched& region : regions_) region.n_inside = 0, region.expected = {};
  for (std::size_t i = 0; i < keyframe_.size(); ++i) {
    Watched& region = regions_[region_of_point_[i]];
    const Vector2 step = region.prediction.step();
    if (!is_measured(region_of_point_[i])) {
      const Vector2 common = common_.of(keyframe_[i]);
      expected_[i] = {common.u + region.off_common.u, common.v + region.off_common.v};
    } else if (i < judged.points.size() && is_used(judged.points[i])) {
      expected_[i] = {judged.points[i].u_px + step.u, judged.points[i].v_px + step.v};
    } else {
      expected_[i] = {keyframe_[i].u + region.offset.u + step.u, keyframe_[i].v + region.offset.v + step.v};
    }
    const Vector2& at = expected_[i];
    const double share = 1.0 / region.n_points;
    region.expected = {region.expected.u + share * (at.u - keyframe_[i].u),
                       region.expected.v + share * (at.v - keyframe_[i].v)};
    if (at.u >= 0.0 && at.v >= 0.0 && at.u < config_.width_px && at.v < config_.height_px) ++region.n_inside;
  }
}

void RegionFollower::judge_states() noexcept {
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    Watched& region = regions_[r];
    if (is_measured(r)) {
      region.state = RegionState::kMeasuring;
      region.n_unmeasured = 0;
      continue;
    }
    region.n_unmeasured = std::min(region.n_unmeasured + 1, UINT32_MAX - 1);
    const bool outside = region.n_inside < config_.least_share_inside * region.n_points;
    region.state = outside || region.n_unmeasured > config_.lost_after ? RegionState::kLost : RegionState::kSearching;
  }
}

}  // namespace core
