#include "core/geometry/resting_region.h"

#include <cstddef>

#include "core/tracking/outlier_rejection.h"

namespace core {

namespace {

// The keyframe centre is that of all points, so that a lost point does not shift it.
void remove_zoom(const RestingPoints& points, std::span<const std::uint8_t> counts,
                 std::span<Vector2> motion) noexcept {
  const auto& position = points.position;
  const auto& keyframe = points.keyframe;
  Vector2 now, then, centre;
  double n = 0.0, n_all = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    centre.u += keyframe[i].u, centre.v += keyframe[i].v, n_all += 1.0;
    if (counts[i] == 0) continue;
    now.u += position[i].u, now.v += position[i].v, n += 1.0;
    then.u += keyframe[i].u, then.v += keyframe[i].v;
  }
  if (n == 0.0) return;
  now = {now.u / n, now.v / n}, then = {then.u / n, then.v / n}, centre = {centre.u / n_all, centre.v / n_all};
  double product = 0.0, square = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    const Vector2 from{keyframe[i].u - then.u, keyframe[i].v - then.v};
    product += from.u * (position[i].u - now.u) + from.v * (position[i].v - now.v);
    square += from.u * from.u + from.v * from.v;
  }
  const double growth = square > 0.0 ? product / square - 1.0 : 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    motion[i] = {position[i].u - keyframe[i].u - growth * (keyframe[i].u - centre.u),
                 position[i].v - keyframe[i].v - growth * (keyframe[i].v - centre.v)};
  }
}

}  // namespace

void follow_resting_region(const RestingPoints& points, double sigma_px, std::span<Vector2> motion,
                           std::span<std::uint8_t> inlier) noexcept {
  MlesacConfig mlesac;
  mlesac.sigma_px = sigma_px;
  remove_zoom(points, points.seen, motion);
  (void)mlesac_translation(motion, points.seen, mlesac, inlier);
  remove_zoom(points, inlier, motion);
  (void)mlesac_translation(motion, points.seen, mlesac, inlier);
}

}  // namespace core
