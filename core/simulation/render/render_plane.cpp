#include "core/simulation/render/render_plane.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/simulation/camera/lens.h"

namespace core::simulation {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kBlock = Texture::kLook;
constexpr double kSmallest = 1e-9;  // of the depth row: nothing is drawn closer to the horizon
constexpr double kFarthest = 1e6;   // cells
constexpr double kSharp_px = 1.499, kGone_px = 1.0;
constexpr double kNear_px = 2.0;       // a pixel farther from an edge does not contain it, even on a curved line
constexpr double kBoxMargin_px = 4.0;  // the same, if the lens makes a pixel up to twice as wide as at the centre

// Where a block's rays meet the plane, in cells.
struct Places {
  double x[kBlock], y[kBlock], depth[kBlock];

  Places(const PlaneView& view, const double* __restrict ray_x, const double* __restrict ray_y) noexcept {
    const auto& h = view.cells;
    const double a0 = h(0, 0), a1 = h(0, 1), a2 = h(0, 2), b0 = h(1, 0), b1 = h(1, 1), b2 = h(1, 2);
    const double d0 = h(2, 0), d1 = h(2, 1), d2 = h(2, 2);
    for (int i = 0; i < kBlock; ++i) {
      depth[i] = d0 * ray_x[i] + d1 * ray_y[i] + d2;
      const double inverse = 1.0 / depth[i];
      x[i] = (a0 * ray_x[i] + a1 * ray_y[i] + a2) * inverse;
      y[i] = (b0 * ray_x[i] + b1 * ray_y[i] + b2) * inverse;
    }
  }

  // True if all are on the near side of the horizon and near enough: true for both ends, it holds between them.
  [[nodiscard]] bool sane() const noexcept {
    const auto sane_at = [this](int i) {
      return depth[i] > kSmallest && std::abs(x[i]) < kFarthest && std::abs(y[i]) < kFarthest;
    };
    return sane_at(0) && sane_at(kBlock - 1);
  }
};

// The texture's contrast at this ray, 0 .. 1, by the largest number of cells that a pixel spans in any direction.
double contrast(const PlaneView& view, double ray_x, double ray_y, double ray_per_px) noexcept {
  const Vector3d at = view.cells * Vector3d(ray_x, ray_y, 1.0);
  if (at.z() <= kSmallest) return 0.0;
  const double x = at.x() / at.z(), y = at.y() / at.z();
  const Vector2d gx = (view.cells.row(0) - x * view.cells.row(2)).head<2>() / at.z();
  const Vector2d gy = (view.cells.row(1) - y * view.cells.row(2)).head<2>() / at.z();
  const double sum = gx.squaredNorm() + gy.squaredNorm(), area = gx.x() * gy.y() - gx.y() * gy.x();
  const double widest = std::sqrt(0.5 * (sum + std::sqrt(std::max(0.0, sum * sum - 4.0 * area * area)))) * ray_per_px;
  return std::clamp((1.0 / widest - kGone_px) / (kSharp_px - kGone_px), 0.0, 1.0);
}

// d(ray) / d(pixel), to first order around a ray.
Matrix2d ray_slope(const LineRays& rays, double x, double y) noexcept {
  if (rays.lens->model == LensParameters::Model::kNone) return Matrix2d::Identity() * rays.ray_per_px;
  constexpr double kStep = 1e-5;
  const Ray right = distort(*rays.lens, {x + kStep, y}), left = distort(*rays.lens, {x - kStep, y});
  const Ray below = distort(*rays.lens, {x, y + kStep}), above = distort(*rays.lens, {x, y - kStep});
  Matrix2d bent;
  bent << right.x - left.x, below.x - above.x, right.y - left.y, below.y - above.y;
  bent /= 2.0 * kStep;
  const double determinant = bent.determinant();
  if (!(std::abs(determinant) > 1e-3)) return Matrix2d::Identity() * rays.ray_per_px;
  return bent.inverse() * rays.ray_per_px;
}

// One edge of a plate: line times (ray x, ray y, 1) is positive inside.
struct Edge {
  double x, y, one;
  [[nodiscard]] double at(double ray_x, double ray_y) const noexcept { return x * ray_x + y * ray_y + one; }
};

// Left and right, top and bottom.
std::array<Edge, 4> edges_of(const PlaneView& view, double half_x, double half_y) noexcept {
  const auto edge = [&view](double half, Eigen::Index axis, double sign) -> Edge {
    const Vector3d line = half * view.cells.row(2) + sign * view.cells.row(axis);
    return {line.x(), line.y(), line.z()};
  };
  return {edge(half_x, 0, 1.0), edge(half_x, 0, -1.0), edge(half_y, 1, 1.0), edge(half_y, 1, -1.0)};
}

// Edges measured in pixels around one ray: signed distance and unit normal.
class Gauge {
 public:
  Gauge(const std::array<Edge, 4>& edges, const LineRays& rays, double ray_x, double ray_y) noexcept : edges_(edges) {
    const Matrix2d slope = ray_slope(rays, ray_x, ray_y);
    for (std::size_t k = 0; k < 4; ++k) {
      const Vector2d gradient = slope.transpose() * Vector2d(edges[k].x, edges[k].y);
      const double length = gradient.norm();
      per_px_[k] = 1.0 / std::max(length, 1e-300);
      normal_[k] = length > 0.0 ? Vector2d(gradient / length) : Vector2d(1.0, 0.0);
    }
  }

  [[nodiscard]] double distance_px(std::size_t k, double ray_x, double ray_y) const noexcept {
    return edges_[k].at(ray_x, ray_y) * per_px_[k];
  }
  // No edge comes near the pixels first .. last, all inside; between their rays an edge is straight to a small part of
  // a pixel.
  [[nodiscard]] bool holds(const LineRays& rays, int first, int last) const noexcept {
    for (std::size_t k = 0; k < 4; ++k) {
      const double a = distance_px(k, rays.x[first], rays.y[first]);
      const double b = distance_px(k, rays.x[last], rays.y[last]);
      if (std::min(a, b) < kNear_px) return false;
    }
    return true;
  }
  [[nodiscard]] float share(double ray_x, double ray_y) const noexcept {
    std::array<double, 4> of{};
    for (std::size_t k = 0; k < 4; ++k) {
      of[k] = half_plane_share(distance_px(k, ray_x, ray_y), normal_[k].x(), normal_[k].y());
    }
    return static_cast<float>(std::max(0.0, of[0] + of[1] - 1.0) * std::max(0.0, of[2] + of[3] - 1.0));
  }

 private:
  const std::array<Edge, 4>& edges_;
  std::array<double, 4> per_px_{};
  std::array<Vector2d, 4> normal_;
};

// No ray of the line comes near the plate if their box lies outside one edge.
bool misses(const std::array<Edge, 4>& edges, const LineRays& rays) noexcept {
  return std::any_of(edges.begin(), edges.end(), [&rays](const Edge& edge) {
    return edge.at(rays.middle_x, rays.middle_y) + std::abs(edge.x) * rays.half_x + std::abs(edge.y) * rays.half_y <
           0.0;
  });
}

// The same for the pixels first .. last, by the rays at both ends.
bool misses(const std::array<Edge, 4>& edges, const LineRays& rays, int first, int last) noexcept {
  const double margin = kBoxMargin_px * rays.ray_per_px;
  return std::any_of(edges.begin(), edges.end(), [&](const Edge& edge) {
    const double nearest = std::max(edge.at(rays.x[first], rays.y[first]), edge.at(rays.x[last], rays.y[last]));
    return nearest + (std::abs(edge.x) + std::abs(edge.y)) * margin < 0.0;
  });
}

}  // namespace

LineRays::LineRays(const double* ray_x, const double* ray_y, int n, const CameraParameters& camera,
                   double zoom) noexcept
    : x(ray_x), y(ray_y), length(n), ray_per_px(1.0 / (camera.alpha_px * zoom)), lens(&camera.lens) {
  double low_x = x[n - 1], high_x = low_x, low_y = y[n - 1], high_y = low_y;
  for (int i = 0; i < n; i += kBlock) {
    low_x = std::min(low_x, x[i]), high_x = std::max(high_x, x[i]);
    low_y = std::min(low_y, y[i]), high_y = std::max(high_y, y[i]);
  }
  const double margin = kBoxMargin_px * ray_per_px;
  middle_x = 0.5 * (low_x + high_x), half_x = 0.5 * (high_x - low_x) + margin;
  middle_y = 0.5 * (low_y + high_y), half_y = 0.5 * (high_y - low_y) + margin;
}

PlaneView::PlaneView(const CameraPose& camera, PlanePoint centre, double tilt_rad, double depth_mm,
                     double pitch_mm) noexcept
    : in_front(depth_mm > camera.z_mm) {
  const Eigen::Matrix3d& world = camera.attitude;
  const double distance_mm = depth_mm - camera.z_mm;
  const Eigen::RowVector3d x = distance_mm * world.row(0) + (camera.x_mm - centre.x_mm) * world.row(2);
  const Eigen::RowVector3d y = distance_mm * world.row(1) + (camera.y_mm - centre.y_mm) * world.row(2);
  const double c = std::cos(tilt_rad), s = std::sin(tilt_rad);
  cells.row(0) = (c * x + s * y) / pitch_mm;
  cells.row(1) = (c * y - s * x) / pitch_mm;
  cells.row(2) = world.row(2);
}

void draw_plane(const PlaneView& view, const Texture& texture, const LineRays& rays, int begin, int end,
                float* light) noexcept {
  const auto mean = static_cast<float>(texture.mean());
  for (int u = begin; u < end; u += kBlock) {
    const int middle = std::min(u + kBlock / 2, rays.length - 1);
    const auto share = static_cast<float>(contrast(view, rays.x[middle], rays.y[middle], rays.ray_per_px));
    const Places places(view, rays.x + u, rays.y + u);
    if (!view.in_front || share <= 0.0F || !places.sane()) {
      std::fill_n(light + u, kBlock, mean);
      continue;
    }
    texture.look(places.x, places.y, light + u);
    if (share >= 1.0F) continue;
    for (int i = 0; i < kBlock; ++i) light[u + i] = mean + share * (light[u + i] - mean);
  }
}

PixelRange cover_plate(const PlaneView& view, double half_x, double half_y, const LineRays& rays,
                       float* cover) noexcept {
  PixelRange range;
  const std::array<Edge, 4> edges = edges_of(view, half_x, half_y);
  if (!view.in_front || misses(edges, rays)) return range;
  for (int u = 0; u < rays.length; u += kBlock) {
    const int last = std::min(u + kBlock, rays.length) - 1;
    if (misses(edges, rays, u, last)) {
      if (range.end > 0) std::fill_n(cover + u, kBlock, 0.0F);
      continue;
    }
    if (range.end == 0) range.begin = u;
    range.end = last + 1;
    const Gauge gauge(edges, rays, rays.x[(u + last) / 2], rays.y[(u + last) / 2]);
    const bool inside = gauge.holds(rays, u, last);
    for (int i = u; i < u + kBlock; ++i) cover[i] = inside ? 1.0F : gauge.share(rays.x[i], rays.y[i]);
  }
  return range;
}

double half_plane_share(double distance_px, double normal_x, double normal_y) noexcept {
  const double wide = std::max(std::abs(normal_x), std::abs(normal_y));
  const double narrow = std::min(std::abs(normal_x), std::abs(normal_y));
  const double outer = 0.5 * (wide + narrow), inner = 0.5 * (wide - narrow), d = std::abs(distance_px);
  if (d >= outer) return distance_px > 0.0 ? 1.0 : 0.0;
  const double beyond = d <= inner ? 0.5 - d / wide : (outer - d) * (outer - d) / (2.0 * wide * narrow);
  return distance_px > 0.0 ? 1.0 - beyond : beyond;
}

}  // namespace core::simulation
