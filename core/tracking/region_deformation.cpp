#include "core/tracking/region_deformation.h"

#include <algorithm>
#include <cmath>

#include "core/linear/median.h"

namespace core {

namespace {

constexpr double kOwnSpread = 0.003;     // of a region's deformation about the common one: depth, own motion
constexpr double kCommonSpread = 0.05;   // standard deviation of the common deformation
constexpr double kLeastSigma_px = 0.01;  // of a point: the stated sigma does not cover all of its error
constexpr double kFar = 4.5;             // multiple of the median distance from the fit; about five sigma of an axis
constexpr int kGates = 2;                // the first fit is biased by far points
constexpr std::size_t kLeastForGate = 5;

double precision(double spread) noexcept { return 1.0 / (spread * spread); }

}  // namespace

RegionDeformation::RegionDeformation(const std::vector<Vector2>& keyframe,
                                     const std::vector<std::uint16_t>& region_of_point, std::size_t n_regions)
    : keyframe_(keyframe), is_inlier_(keyframe.size(), 1), is_used_(keyframe.size()), off_(keyframe.size()) {
  for (std::size_t r = 0, first = 0; r < n_regions; ++r) {
    Region& region = regions_.emplace_back();
    region.first = first;
    while (first < keyframe.size() && region_of_point[first] == r) ++first;
    region.n = first - region.first;
  }
  sorted_.reserve(keyframe.size());
}

void RegionDeformation::update(const std::vector<KltPoint>& found) noexcept {
  for (std::size_t i = 0; i < is_used_.size(); ++i) is_used_[i] = found[i].seen && is_inlier_[i] != 0 ? 1 : 0;
  for (Region& region : regions_) region.moments = moments_of(region, found);
  for (int k = 0; k < kGates; ++k) {
    const Deformation all = common();
    for (Region& region : regions_) {
      region.now = region.moments.fit(all, precision(kOwnSpread));
      if (leave_out_far(region, found)) region.moments = moments_of(region, found);
    }
  }
  const Deformation all = common();
  for (Region& region : regions_) region.now = region.moments.fit(all, precision(kOwnSpread));
}

void RegionDeformation::learn(const TrackFrame& judged) noexcept {
  for (std::size_t i = 0; i < is_inlier_.size() && i < judged.points.size(); ++i)
    is_inlier_[i] = judged.points[i].inlier ? 1 : 0;
}

RegionDeformation::Moments RegionDeformation::moments_of(const Region& region,
                                                         const std::vector<KltPoint>& found) const noexcept {
  Moments m;
  const auto weight = [&](std::size_t i) {
    return 1.0 / (found[i].sigma_px * found[i].sigma_px + kLeastSigma_px * kLeastSigma_px);
  };
  for (std::size_t i = region.first; i < region.first + region.n; ++i) {
    if (is_used_[i] == 0) continue;
    const double w = weight(i);
    const Vector2 &x = keyframe_[i], p = motion(i, found);
    m.weight += w;
    m.mean_x = {m.mean_x.u + w * x.u, m.mean_x.v + w * x.v};
    m.mean_p = {m.mean_p.u + w * p.u, m.mean_p.v + w * p.v};
  }
  if (!(m.weight > 0.0)) return {};
  m.mean_x = {m.mean_x.u / m.weight, m.mean_x.v / m.weight};
  m.mean_p = {m.mean_p.u / m.weight, m.mean_p.v / m.weight};
  for (std::size_t i = region.first; i < region.first + region.n; ++i) {
    if (is_used_[i] == 0) continue;
    const double w = weight(i);
    const Vector2 x{keyframe_[i].u - m.mean_x.u, keyframe_[i].v - m.mean_x.v};
    const Vector2 p{motion(i, found).u - m.mean_p.u, motion(i, found).v - m.mean_p.v};
    m.uu += w * x.u * x.u, m.uv += w * x.u * x.v, m.vv += w * x.v * x.v;
    m.motion = m.motion + Deformation{w * p.u * x.u, w * p.u * x.v, w * p.v * x.u, w * p.v * x.v};
  }
  return m;
}

Deformation RegionDeformation::Moments::fit(const Deformation& prior, double own) const noexcept {
  const double a = uu + own, b = uv, c = vv + own, determinant = a * c - b * b;
  const Deformation m = motion + own * prior;
  return {(m.uu * c - m.uv * b) / determinant, (m.uv * a - m.uu * b) / determinant, (m.vu * c - m.vv * b) / determinant,
          (m.vv * a - m.vu * b) / determinant};
}

Deformation RegionDeformation::common() const noexcept {
  Moments sum;
  for (const Region& region : regions_) {
    const Moments& m = region.moments;
    sum.uu += m.uu, sum.uv += m.uv, sum.vv += m.vv, sum.motion = sum.motion + m.motion;
  }
  return sum.fit({}, precision(kCommonSpread));
}

bool RegionDeformation::leave_out_far(const Region& region, const std::vector<KltPoint>& found) noexcept {
  sorted_.clear();
  for (std::size_t i = region.first; i < region.first + region.n; ++i) {
    if (is_used_[i] == 0) continue;
    const Moments& m = region.moments;
    const Vector2 fitted = region.now.of({keyframe_[i].u - m.mean_x.u, keyframe_[i].v - m.mean_x.v});
    const Vector2 p = motion(i, found);
    off_[i] = length(p.u - m.mean_p.u - fitted.u, p.v - m.mean_p.v - fitted.v);
    sorted_.push_back(off_[i]);
  }
  if (sorted_.size() < kLeastForGate) return false;
  bool is_changed = false;
  const double far = kFar * std::max(kLeastSigma_px, median_in_place(sorted_));
  for (std::size_t i = region.first; i < region.first + region.n; ++i)
    if (is_used_[i] != 0 && off_[i] > far) is_used_[i] = 0, is_changed = true;
  return is_changed;
}

}  // namespace core
