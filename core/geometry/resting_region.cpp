#include "core/geometry/resting_region.h"

#include <cstddef>

#include "core/tracking/outlier_rejection.h"

namespace core {

namespace {

// Zoom and rotation of the points that count: least squares of p - p_mean on p0 - p0_mean. Removed about the keyframe
// centre of all points, so that a lost point does not shift it. Returns the rotation.
double remove_zoom_and_turn(const RestingPoints& points, std::span<const std::uint8_t> counts,
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
  if (n == 0.0) return 0.0;
  now = {now.u / n, now.v / n}, then = {then.u / n, then.v / n}, centre = {centre.u / n_all, centre.v / n_all};
  double along = 0.0, across = 0.0, square = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    const Vector2 from{keyframe[i].u - then.u, keyframe[i].v - then.v};
    const Vector2 to{position[i].u - now.u, position[i].v - now.v};
    along += from.u * to.u + from.v * to.v;
    across += from.u * to.v - from.v * to.u;
    square += from.u * from.u + from.v * from.v;
  }
  const double growth = square > 0.0 ? along / square - 1.0 : 0.0, turn = square > 0.0 ? across / square : 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const Vector2 from{keyframe[i].u - centre.u, keyframe[i].v - centre.v};
    motion[i] = {position[i].u - keyframe[i].u - growth * from.u + turn * from.v,
                 position[i].v - keyframe[i].v - growth * from.v - turn * from.u};
  }
  return turn;
}

}  // namespace

double follow_resting_region(const RestingPoints& points, double sigma_px, std::span<Vector2> motion,
                             std::span<std::uint8_t> inlier) noexcept {
  MlesacConfig mlesac;
  mlesac.sigma_px = sigma_px;
  (void)remove_zoom_and_turn(points, points.seen, motion);
  (void)mlesac_translation(motion, points.seen, mlesac, inlier);
  const double turn = remove_zoom_and_turn(points, inlier, motion);
  (void)mlesac_translation(motion, points.seen, mlesac, inlier);
  return turn;
}

}  // namespace core
