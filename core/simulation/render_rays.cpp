#include "core/simulation/render_rays.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/simulation/lens.h"

namespace core::simulation {
namespace {

constexpr int kSpacing_px = 8;
constexpr double kWidestRay = 100.0;  // 89.4 degrees

// Cubic through the values at -1, 0, 1, 2, evaluated at s.
std::array<double, 4> lagrange(double s) noexcept {
  const double a = s + 1.0, c = s - 1.0, d = s - 2.0;
  return {s * c * d / -6.0, a * c * d / 2.0, a * s * d / -2.0, a * s * c / 6.0};
}

// Knots reach as far as a pixel may look when the focal length breathes, and two further.
int margin_knots(int n_pixels, double zoom_rms) {
  return 3 + static_cast<int>(std::ceil(8.0 * zoom_rms * n_pixels / kSpacing_px));
}

double sane(double ray) noexcept { return std::isfinite(ray) ? std::clamp(ray, -kWidestRay, kWidestRay) : 0.0; }

}  // namespace

RayMap::RayMap(const CameraParameters& camera, double zoom_rms)
    : alpha_px_(camera.alpha_px), bent_(camera.lens.model != LensParameters::Model::kNone) {
  const auto axis = [zoom_rms](int n_pixels, double centre_px) -> Axis {
    const int margin = margin_knots(n_pixels, zoom_rms);
    return {n_pixels, n_pixels / kSpacing_px + 2 * margin, 1, centre_px, -1.0 * margin * kSpacing_px};
  };
  u_ = axis(camera.width_px, camera.cx_px);
  v_ = axis(camera.height_px, camera.cy_px);
  v_.stride = u_.n_knots;
  if (!bent_) return;
  for (int j = 0; j < v_.n_knots; ++j) {
    for (int i = 0; i < u_.n_knots; ++i) {
      const double u_px = u_.first_px + i * kSpacing_px, v_px = v_.first_px + j * kSpacing_px;
      const Ray ray = undistort(camera.lens, {(u_px - camera.cx_px) / alpha_px_, (v_px - camera.cy_px) / alpha_px_});
      knot_x_.push_back(sane(ray.x));
      knot_y_.push_back(sane(ray.y));
    }
  }
}

void RayMap::row(int v, double zoom, double* x, double* y) const noexcept { line(u_, v_, v, zoom, x, y); }

void RayMap::column(int u, double zoom, double* x, double* y) const noexcept {
  // Without a lens `line` gives the ray along the line first.
  if (bent_) return line(v_, u_, u, zoom, x, y);
  line(v_, u_, u, zoom, y, x);
}

void RayMap::line(const Axis& along, const Axis& across, double across_px, double zoom, double* x,
                  double* y) const noexcept {
  if (!bent_) {
    const double scale = 1.0 / (alpha_px_ * zoom);
    const double other = (across_px - across.centre_px) * scale;
    for (int i = 0; i < along.n_pixels; ++i) {
      x[i] = (i - along.centre_px) * scale;
      y[i] = other;
    }
    return;
  }
  // Place on the unzoomed sensor, in knots.
  const auto place = [zoom](const Axis& axis, double px) {
    const double knots = (axis.centre_px + (px - axis.centre_px) / zoom - axis.first_px) / kSpacing_px;
    return std::clamp(knots, 1.0, axis.n_knots - 3.0);
  };
  const double at = place(across, across_px);
  const int row = static_cast<int>(at);
  const std::array<double, 4> w = lagrange(at - row);
  const auto knot = [&](const std::vector<double>& knots, int k) {
    const double* p = knots.data() + static_cast<std::ptrdiff_t>(k) * along.stride +
                      static_cast<std::ptrdiff_t>(row - 1) * across.stride;
    const std::ptrdiff_t next = across.stride;
    return w[0] * p[0] + w[1] * p[next] + w[2] * p[2 * next] + w[3] * p[3 * next];
  };
  std::array<double, 4> kx{}, ky{};
  for (int i = 0, cell = -1; i < along.n_pixels; ++i) {
    const double p = place(along, i);
    if (cell != static_cast<int>(p)) {
      cell = static_cast<int>(p);
      for (int k = 0; k < 4; ++k) {
        kx[static_cast<std::size_t>(k)] = knot(knot_x_, cell - 1 + k);
        ky[static_cast<std::size_t>(k)] = knot(knot_y_, cell - 1 + k);
      }
    }
    const std::array<double, 4> s = lagrange(p - cell);
    x[i] = s[0] * kx[0] + s[1] * kx[1] + s[2] * kx[2] + s[3] * kx[3];
    y[i] = s[0] * ky[0] + s[1] * ky[1] + s[2] * ky[2] + s[3] * ky[3];
  }
}

}  // namespace core::simulation
