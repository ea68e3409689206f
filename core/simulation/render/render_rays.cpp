#include "core/simulation/render/render_rays.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/simulation/camera/lens.h"

namespace core::simulation {
namespace {

constexpr int kSpacing_px = 8;
constexpr double kWidestRay = 100.0;  // 89.4 degrees

// Weights at s of the cubic through the values at -1, 0, 1, 2.
std::array<double, 4> lagrange(double s) noexcept {
  const double a = s + 1.0, c = s - 1.0, d = s - 2.0;
  return {s * c * d / -6.0, a * c * d / 2.0, a * s * d / -2.0, a * s * c / 6.0};
}

// The same as a polynomial.
struct Cubic {
  double c0, c1, c2, c3;

  template <class Value>
  explicit Cubic(const Value& value) noexcept {
    const double a = value(-1), b = value(0), c = value(1), d = value(2);
    c0 = b, c1 = c - a / 3.0 - b / 2.0 - d / 6.0, c2 = (a + c) / 2.0 - b, c3 = (d - a) / 6.0 + (b - c) / 2.0;
  }
  [[nodiscard]] double at(double s) const noexcept { return c0 + s * (c1 + s * (c2 + s * c3)); }
};

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
    return {n_pixels, n_pixels / kSpacing_px + 2 + 2 * margin, 1, centre_px, -1.0 * margin * kSpacing_px};
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
  // Place on the unzoomed sensor, in knots: of pixel i, first + i step.
  const double step = 1.0 / (zoom * kSpacing_px);
  const auto place = [step](const Axis& axis, double px) {
    const double knots = (axis.centre_px - axis.first_px) / kSpacing_px + (px - axis.centre_px) * step;
    return std::clamp(knots, 1.0, axis.n_knots - 2.0001);
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
  for (int i = 0; i < along.n_pixels;) {
    const double first = place(along, i);
    const int cell = static_cast<int>(first);
    const Cubic cx([&](int k) { return knot(knot_x_, cell + k); }), cy([&](int k) { return knot(knot_y_, cell + k); });
    // The last pixel of the cell, and at least this one.
    const int end = std::min(along.n_pixels, i + std::max(1, static_cast<int>(std::ceil((cell + 1 - first) / step))));
    const double s0 = first - cell - i * step;
    for (; i < end; ++i) {
      const double s = s0 + i * step;
      x[i] = cx.at(s);
      y[i] = cy.at(s);
    }
  }
}

}  // namespace core::simulation
