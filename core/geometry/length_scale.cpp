#include "core/geometry/length_scale.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

namespace core {
namespace {

using Eigen::Vector3d;

double length_px(const KnownLength& length) noexcept {
  return std::hypot(length.to_px.u - length.from_px.u, length.to_px.v - length.from_px.v);
}

Vector3d ray_of(const CameraModel& camera, const Vector2& px) {
  return {(px.u - camera.cx) / camera.fx, (px.v - camera.cy) / camera.fy, 1.0};
}

// A plane n . P = distance; lengths below are per unit of distance.
struct Tilt {
  Vector3d normal;  // pointing away from the camera
  double angle_deg;

  [[nodiscard]] std::optional<Vector3d> meet(const Vector3d& ray) const {
    const double along = normal.dot(ray);
    if (!(along > 0.02)) return std::nullopt;  // the plane is seen edge-on
    return Vector3d(ray / along);
  }
  // Length in the plane of one pixel along the direction at `ray`.
  [[nodiscard]] std::optional<double> per_px(const CameraModel& camera, const ScaledPlace& place) const {
    const Vector3d ray = ray_of(camera, place.centre_px);
    const Vector3d step(place.direction.u / camera.fx, place.direction.v / camera.fy, 0.0);
    const double along = normal.dot(ray);
    if (!(along > 0.02)) return std::nullopt;
    return Vector3d(step / along - ray * normal.dot(step) / (along * along)).norm();
  }
};

struct Candidate {
  double angle_deg = 0.0;
  double chi_square = 0.0;
  std::vector<double> scale;  // mm/px per place
};

// nullopt: a length or place would be seen edge-on or from behind.
std::optional<Candidate> judge(const Tilt& tilt, std::span<const KnownLength> lengths,
                               std::span<const ScaledPlace> places, const CameraModel& camera, double sigma_px) {
  std::vector<double> per_distance;  // length in the plane for distance 1
  double mixed = 0.0, square = 0.0;
  for (const KnownLength& known : lengths) {
    const auto from = tilt.meet(ray_of(camera, known.from_px));
    const auto to = tilt.meet(ray_of(camera, known.to_px));
    if (!from || !to) return std::nullopt;
    per_distance.push_back((*to - *from).norm());
    const double weight = length_px(known) / known.length_mm;  // px per mm: equal variance for all lengths
    mixed += weight * weight * known.length_mm * per_distance.back();
    square += weight * weight * per_distance.back() * per_distance.back();
  }
  const double distance_mm = mixed / square;
  Candidate out{tilt.angle_deg, 0.0, {}};
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const double error_px =
        (lengths[i].length_mm - distance_mm * per_distance[i]) * length_px(lengths[i]) / lengths[i].length_mm;
    out.chi_square += error_px * error_px / (2.0 * sigma_px * sigma_px);
  }
  for (const ScaledPlace& place : places) {
    const auto per_px = tilt.per_px(camera, place);
    if (!per_px) return std::nullopt;
    out.scale.push_back(distance_mm * *per_px);
  }
  return out;
}

std::vector<Candidate> try_planes(std::span<const KnownLength> lengths, std::span<const ScaledPlace> places,
                                  const CameraModel& camera, double sigma_px, double up_to_deg) {
  constexpr int kAngles = 80;
  constexpr int kSides = 48;
  std::vector<Candidate> out;
  for (int i = 0; i <= kAngles; ++i) {
    const double angle_deg = up_to_deg * i / kAngles;
    const double angle = angle_deg * std::numbers::pi / 180.0;
    for (int k = 0; k < (i == 0 ? 1 : kSides); ++k) {
      const double side = 2.0 * std::numbers::pi * k / kSides;
      const Tilt tilt{{std::sin(angle) * std::cos(side), std::sin(angle) * std::sin(side), std::cos(angle)}, angle_deg};
      if (auto candidate = judge(tilt, lengths, places, camera, sigma_px)) out.push_back(std::move(*candidate));
    }
  }
  return out;
}

}  // namespace

LengthScale fit_length_scale(std::span<const KnownLength> lengths, double sigma_px) noexcept {
  LengthScale out;
  double mixed = 0.0, square = 0.0;
  for (const KnownLength& known : lengths) {
    mixed += known.length_mm * length_px(known);
    square += known.length_mm * known.length_mm;
  }
  if (!(mixed > 0.0) || !std::isfinite(mixed)) return out;
  out.mm_per_px = lengths.size() == 1 ? lengths[0].length_mm / length_px(lengths[0]) : square / mixed;
  const double px_sigma = std::numbers::sqrt2 * sigma_px;  // sigma of a length in px: it has two ends
  double worst_error = -1.0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const double d = length_px(lengths[i]);
    const double error = (d - lengths[i].length_mm / out.mm_per_px) / px_sigma;
    out.chi_square += error * error;
    if (std::abs(error) <= worst_error) continue;
    worst_error = std::abs(error);
    out.worst = i;
    out.worst_share = lengths[i].length_mm / (d * out.mm_per_px) - 1.0;
  }
  const double n_free = static_cast<double>(lengths.size()) - 1.0;
  const double growth = n_free > 0.0 ? std::sqrt(std::max(1.0, out.chi_square / n_free)) : 1.0;
  out.sigma = growth * out.mm_per_px * out.mm_per_px * px_sigma / std::sqrt(square);
  return out;
}

ObliquenessBound unexcluded_obliqueness(std::span<const KnownLength> lengths, std::span<const ScaledPlace> places,
                                        const CameraModel& camera, double sigma_px, double up_to_deg) {
  constexpr double kExcluded = 5.99;  // chi square of two degrees of freedom, 95 %
  ObliquenessBound out;
  const double common = fit_length_scale(lengths, sigma_px).mm_per_px;
  if (!camera.calibrated() || !(common > 0.0)) return out;
  const std::vector<Candidate> planes = try_planes(lengths, places, camera, sigma_px, up_to_deg);
  if (planes.empty()) return out;
  double best = std::numeric_limits<double>::infinity();
  for (const Candidate& plane : planes) best = std::min(best, plane.chi_square);
  constexpr double kHuge = std::numeric_limits<double>::infinity();
  out.places.assign(places.size(), {kHuge, 0.0});
  out.least_deg = up_to_deg;
  for (const Candidate& plane : planes) {
    if (plane.chi_square > best + kExcluded) continue;
    out.least_deg = std::min(out.least_deg, plane.angle_deg);
    out.largest_deg = std::max(out.largest_deg, plane.angle_deg);
    for (std::size_t i = 0; i < places.size(); ++i) {
      out.places[i].low = std::min(out.places[i].low, plane.scale[i] / common);
      out.places[i].high = std::max(out.places[i].high, plane.scale[i] / common);
    }
    if (plane.scale.empty()) continue;
    const auto [low, high] = std::minmax_element(plane.scale.begin(), plane.scale.end());
    out.between = std::max(out.between, *high / *low);
  }
  return out;
}

}  // namespace core
