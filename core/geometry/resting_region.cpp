#include "core/geometry/resting_region.h"

#include <cmath>
#include <cstddef>

#include "core/geometry/channel_layout.h"
#include "core/tracking/outlier_rejection.h"

namespace core {

namespace {

constexpr double kLeastAcross = 0.1;  // share of the square of the places

// Places of the points that count, from their centre, without the part that is linear in the readout.
class PlaceAcrossReadout {
 public:
  template <class Counts>
  PlaceAcrossReadout(std::span<const Vector2> place, std::span<const double> readout_share, const Counts& counts)
      : place_(place), readout_share_(readout_share) {
    double n = 0.0;
    for (std::size_t i = 0; i < place.size(); ++i) {
      if (!counts(i)) continue;
      centre_.u += place[i].u, centre_.v += place[i].v, mean_share_ += readout_share[i], n += 1.0;
    }
    if (n == 0.0) return;
    centre_.u /= n, centre_.v /= n, mean_share_ /= n;
    double square = 0.0, whole = 0.0;
    Vector2 product;
    for (std::size_t i = 0; i < place.size(); ++i) {
      if (!counts(i)) continue;
      const double share = readout_share[i] - mean_share_;
      const Vector2 from{place[i].u - centre_.u, place[i].v - centre_.v};
      square += share * share, product.u += share * from.u, product.v += share * from.v;
      whole += from.u * from.u + from.v * from.v;
    }
    const double along = square > 0.0 ? (product.u * product.u + product.v * product.v) / square : whole;
    if (whole - along > kLeastAcross * whole) per_share_ = {product.u / square, product.v / square};
  }

  [[nodiscard]] Vector2 operator()(std::size_t i) const noexcept {
    const double share = readout_share_[i] - mean_share_;
    return {place_[i].u - centre_.u - share * per_share_.u, place_[i].v - centre_.v - share * per_share_.v};
  }

 private:
  std::span<const Vector2> place_;
  std::span<const double> readout_share_;
  Vector2 centre_, per_share_;
  double mean_share_ = 0.0;
};

struct ZoomAndTurn {
  double growth = 0.0, turn_rad = 0.0;
};

// Of displacements moved(i) of the points that count; the places' mean is zero, so that of the motion is immaterial.
template <class Counts, class Moved>
ZoomAndTurn zoom_and_turn(std::span<const Vector2> place, std::span<const double> readout_share, const Counts& counts,
                          const Moved& moved) {
  const PlaceAcrossReadout across_readout(place, readout_share, counts);
  double along = 0.0, across = 0.0, square = 0.0;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (!counts(i)) continue;
    const Vector2 from = across_readout(i), by = moved(i);
    along += from.u * by.u + from.v * by.v;
    across += from.u * by.v - from.v * by.u;
    square += from.u * from.u + from.v * from.v;
  }
  return square > 0.0 ? ZoomAndTurn{along / square, across / square} : ZoomAndTurn{};
}

// Removed about the centre of all points, so that a lost point does not shift it. Returns the rotation.
double remove_zoom_and_turn(const RestingPoints& points, std::span<const std::uint8_t> counts,
                            std::span<Vector2> motion) noexcept {
  const auto& position = points.position;
  const auto& place = points.turned;
  const auto moved = [&](std::size_t i) {
    return Vector2{position[i].u - points.keyframe[i].u, position[i].v - points.keyframe[i].v};
  };
  const auto [growth, turn] = zoom_and_turn(
      place, points.readout_share, [&](std::size_t i) { return counts[i] != 0; }, moved);
  const Vector2 centre = centre_of(place);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const Vector2 from{place[i].u - centre.u, place[i].v - centre.v}, by = moved(i);
    motion[i] = {by.u - growth * from.u + turn * from.v, by.v - growth * from.v - turn * from.u};
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

// A rotation w moves the ray (x, y, 1) by w x (x, y, 1), seen in the image.
Eigen::Matrix3d shown_rotation(const RestingPoints& points, std::span<const std::uint8_t> inlier, double fx,
                               double fy) noexcept {
  const auto counts = [&](std::size_t i) { return inlier[i] != 0; };
  Eigen::Matrix3d shown;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d w = Eigen::Vector3d::Unit(axis);
    Vector2 mean;
    double n = 0.0;
    const auto moved = [&](std::size_t i) {
      const double x = points.turned[i].u / fx, y = points.turned[i].v / fy;
      const Eigen::Vector3d by = w.cross(Eigen::Vector3d(x, y, 1.0));
      const Vector2 px{fx * (by.x() - x * by.z()), fy * (by.y() - y * by.z())};
      mean.u += px.u, mean.v += px.v, n += 1.0;
      return px;
    };
    const double turn_rad = zoom_and_turn(points.turned, points.readout_share, counts, moved).turn_rad;
    shown.col(axis) << mean.u / (n * fx), mean.v / (n * fy), turn_rad;
  }
  return shown;
}

double spread_of_turn_px(std::span<const Vector2> points, std::span<const double> readout_share) noexcept {
  const PlaceAcrossReadout place(points, readout_share, [](std::size_t) { return true; });
  double squares = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2 from = place(i);
    squares += from.u * from.u + from.v * from.v;
  }
  return points.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(points.size()));
}

}  // namespace core
