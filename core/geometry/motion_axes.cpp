#include "core/geometry/motion_axes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/linear/median.h"

namespace core {

namespace {

constexpr double kLeastAxisPoints = 3.0;
constexpr double kLeastInBlock = 8.0;  // samples: fewer tell no line
// Hover is slower than this; where the camera's motion is known, the structure may be slow.
constexpr double kBlock_s = 1.0, kBlockOfKnownCamera_s = 4.0;

constexpr double kStray_px = 5.0;           // farther from its region's median, a point is excluded from the zoom
constexpr double kMostZoomNoise_px = 0.05;  // at the farthest region; else zoom is left in

bool is_usable(const TrackPoint& point) noexcept {
  return point.seen && std::isfinite(point.u_px) && std::isfinite(point.v_px);
}

}  // namespace

double PlaneMotion::along_px(double axis_deg) const noexcept {
  const double c = std::cos(axis_deg * std::numbers::pi / 180.0), s = std::sin(axis_deg * std::numbers::pi / 180.0);
  return std::sqrt(std::max(0.0, c * c * uu + 2.0 * c * s * uv + s * s * vv));
}

double PlaneMotion::principal_deg() const noexcept {
  return 0.5 * std::atan2(2.0 * uv, uu - vv) * 180.0 / std::numbers::pi;
}

MotionAxes::MotionAxes(const std::vector<Region>& regions, std::size_t n_points)
    : first_(n_points), is_known_(n_points, 0), seen_(regions.size()), lines_(regions.size()), sums_(regions.size()) {
  const auto count = [&](auto wanted) {
    return std::count_if(regions.begin(), regions.end(), [&](const Region& region) { return wanted(region.role); });
  };
  for (const Region& region : regions) roles_.push_back(region.role);
  u_.reserve(n_points + regions.size()), v_.reserve(n_points + regions.size());
  if (count([](RegionRole role) { return role == RegionRole::kGround; }) > 0) {
    reference_ = Reference::kGround, block_s_ = kBlockOfKnownCamera_s;
  } else if (count([](RegionRole role) { return makes_channel(role); }) > 1) {
    reference_ = Reference::kEachOther, block_s_ = kBlock_s;
  } else {
    const bool has_background = count([](RegionRole role) { return role == RegionRole::kBackground; }) > 0;
    reference_ = has_background ? Reference::kBackground : Reference::kNone;
  }
}

void MotionAxes::Line::add(double t_s, const Vector2& value, double noise_px2) noexcept {
  n += 1.0, t += t_s, tt += t_s * t_s;
  x = {x.u + value.u, x.v + value.v};
  tx = {tx.u + t_s * value.u, tx.v + t_s * value.v};
  uu += value.u * value.u, uv += value.u * value.v, vv += value.v * value.v;
  noise += noise_px2;
}

// The median of each region; its variance is pi / 2 of the mean's.
void MotionAxes::see(const TrackFrame& frame) noexcept {
  const std::size_t n = std::min(first_.size(), frame.points.size());
  std::fill(seen_.begin(), seen_.end(), Seen{});
  zoom_ = {};
  for (std::size_t begin = 0, end = 0; begin < n; begin = end) {
    const std::size_t region = frame.points[begin].region;
    double variance = 0.0;
    Vector2 place;
    u_.clear(), v_.clear();
    for (end = begin; end < n && frame.points[end].region == region; ++end) {
      const TrackPoint& point = frame.points[end];
      if (!is_usable(point)) continue;
      if (is_known_[end] == 0) first_[end] = {point.u_px, point.v_px}, is_known_[end] = 1;
      u_.push_back(point.u_px - first_[end].u), v_.push_back(point.v_px - first_[end].v);
      place = {place.u + first_[end].u, place.v + first_[end].v};
      if (std::isfinite(point.sigma_px)) variance += point.sigma_px * point.sigma_px;
    }
    const auto n_seen = static_cast<double>(u_.size());
    if (region >= seen_.size() || n_seen < kLeastAxisPoints) continue;
    seen_[region] = {{median_in_place(u_), median_in_place(v_)},
                     {place.u / n_seen, place.v / n_seen},
                     0.5 * std::numbers::pi * variance / (n_seen * n_seen),
                     true};
    if (roles_[region] != RegionRole::kBackground) see_zoom(frame, begin, end, seen_[region], variance / n_seen);
  }
}

// Plates do not stretch: what draws the points of a region apart is the camera's zoom, whatever the region does.
void MotionAxes::see_zoom(const TrackFrame& frame, std::size_t begin, std::size_t end, const Seen& region,
                          double variance_px2) noexcept {
  for (std::size_t i = begin; i < end; ++i) {
    const TrackPoint& point = frame.points[i];
    if (!is_usable(point)) continue;
    const Vector2 from{first_[i].u - region.place.u, first_[i].v - region.place.v};
    const Vector2 off{point.u_px - first_[i].u - region.motion.u, point.v_px - first_[i].v - region.motion.v};
    if (length(off) > kStray_px) continue;
    const double square = from.u * from.u + from.v * from.v;
    zoom_.along += from.u * off.u + from.v * off.v;
    zoom_.spread += square, zoom_.noise += square * variance_px2;
  }
}

bool MotionAxes::is_reference(std::size_t region) const noexcept {
  switch (reference_) {
    case Reference::kGround:
      return roles_[region] == RegionRole::kGround;
    case Reference::kEachOther:
      return makes_channel(roles_[region]);
    case Reference::kBackground:
      return roles_[region] == RegionRole::kBackground;
    case Reference::kNone:
      break;
  }
  return false;
}

// Empty: one of its regions is not seen, and the others have another middle.
std::optional<Vector2> MotionAxes::middle() const noexcept {
  Vector2 sum;
  double n = 0.0;
  for (std::size_t r = 0; r < roles_.size(); ++r) {
    if (!is_reference(r)) continue;
    if (!seen_[r].valid) return std::nullopt;
    sum = {sum.u + seen_[r].place.u, sum.v + seen_[r].place.v}, n += 1.0;
  }
  return n > 0.0 ? Vector2{sum.u / n, sum.v / n} : sum;
}

// The median over its regions: one that moves along another axis than the others does not move these.
Vector2 MotionAxes::camera() noexcept {
  u_.clear(), v_.clear();
  for (std::size_t r = 0; r < roles_.size(); ++r)
    if (is_reference(r)) u_.push_back(seen_[r].motion.u), v_.push_back(seen_[r].motion.v);
  return u_.empty() ? Vector2{} : Vector2{median_in_place(u_), median_in_place(v_)};
}

void MotionAxes::remove_zoom(const Vector2& middle) noexcept {
  const double zoom = growth(middle);
  for (Seen& one : seen_) {
    one.motion = {one.motion.u - zoom * (one.place.u - middle.u), one.motion.v - zoom * (one.place.v - middle.v)};
  }
}

// 0: unknown, or so uncertain that it would move the farthest region.
double MotionAxes::growth(const Vector2& middle) const noexcept {
  if (!(zoom_.spread > 0.0) || reference_ == Reference::kBackground || reference_ == Reference::kNone) return 0.0;
  double farthest = 0.0;
  for (std::size_t r = 0; r < roles_.size(); ++r)
    if (seen_[r].valid && makes_channel(roles_[r]))
      farthest = std::max(farthest, length(seen_[r].place.u - middle.u, seen_[r].place.v - middle.v));
  const double sigma = std::sqrt(zoom_.noise) / zoom_.spread;
  return sigma * farthest < kMostZoomNoise_px ? zoom_.along / zoom_.spread : 0.0;
}

void MotionAxes::add(const TrackFrame& frame) noexcept {
  if (!first_ns_) first_ns_ = frame.t_start_ns;
  const double t_s = 1e-9 * static_cast<double>(frame.t_start_ns - *first_ns_);
  if (!(t_s >= duration_s_)) return;
  duration_s_ = t_s;
  if (t_s >= block_begin_s_ + block_s_) {
    end_block();
    block_begin_s_ = t_s;
  }
  see(frame);
  const std::optional<Vector2> about = middle();
  if (!about) return;
  remove_zoom(*about);
  const Vector2 moved = camera();
  for (std::size_t r = 0; r < roles_.size(); ++r) {
    if (!seen_[r].valid || !makes_channel(roles_[r])) continue;
    const Seen& one = seen_[r];
    lines_[r].add(t_s - block_begin_s_, {one.motion.u - moved.u, one.motion.v - moved.v}, one.noise_px2);
  }
}

// What is left beside the line, n - 2 degrees of freedom.
void MotionAxes::end_block() noexcept {
  for (std::size_t r = 0; r < lines_.size(); ++r) {
    const Line line = lines_[r];
    lines_[r] = {};
    const double spread = line.tt - line.t * line.t / std::max(line.n, 1.0);
    if (line.n < kLeastInBlock || !(spread > 0.0)) continue;
    const Vector2 slope{line.tx.u - line.t * line.x.u / line.n, line.tx.v - line.t * line.x.v / line.n};
    const double scale = line.n / (line.n - 2.0);
    PlaneMotion& sum = sums_[r];
    sum.uu += scale * (line.uu - line.x.u * line.x.u / line.n - slope.u * slope.u / spread);
    sum.uv += scale * (line.uv - line.x.u * line.x.v / line.n - slope.u * slope.v / spread);
    sum.vv += scale * (line.vv - line.x.v * line.x.v / line.n - slope.v * slope.v / spread);
    sum.noise_px2 += line.noise;
    sum.n_samples += static_cast<std::uint64_t>(line.n);
  }
}

PlaneMotion MotionAxes::motion(std::size_t region) const noexcept {
  PlaneMotion out = sums_[region];
  if (out.n_samples == 0) return out;
  const auto n = static_cast<double>(out.n_samples);
  out.noise_px2 /= n;
  out.uu = out.uu / n - out.noise_px2, out.vv = out.vv / n - out.noise_px2, out.uv /= n;
  return out;
}

}  // namespace core
