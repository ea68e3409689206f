#include "core/structure/fem/bar_basis.h"

#include <cmath>
#include <numbers>

namespace core::structure {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Legendre polynomials P_0 .. P_n at xi.
VectorXd legendre(int n, double xi) {
  VectorXd p(n + 1);
  p(0) = 1.0;
  if (n > 0) p(1) = xi;
  for (int k = 1; k < n; ++k) p(k + 1) = ((2.0 * k + 1.0) * xi * p(k) - k * p(k - 1)) / (k + 1.0);
  return p;
}

}  // namespace

BarBasis::BarBasis(double length, int bubbles, bool shear, bool axial, int in_series)
    : length_(length), bubbles_(bubbles), shear_(shear), axial_(axial), in_series_(in_series) {}

Index BarBasis::size() const noexcept {
  return 6 + Index{bubbles_} * (1 + (shear_ ? 1 : 0) + (axial_ ? 1 : 0)) + in_series_;
}

// Linear functions of two ends and integrated Legendre polynomials, (P_{n+1} - P_{n-1}) / (2n + 1), scaled to
// orthonormal derivatives.
void BarBasis::linear(double xi, Index first, Index last, Index bubble, VectorXd& value, VectorXd& slope) const {
  const double per_length = 2.0 / length_;
  value(first) = 0.5 * (1.0 - xi), value(last) = 0.5 * (1.0 + xi);
  slope(first) = -0.5 * per_length, slope(last) = 0.5 * per_length;
  if (bubble < 0) return;
  const VectorXd p = legendre(bubbles_ + 1, xi);
  for (int n = 1; n <= bubbles_; ++n) {
    const double scale = std::sqrt(n + 0.5);
    value(bubble + n - 1) = scale * (p(n + 1) - p(n - 1)) / (2.0 * n + 1.0);
    slope(bubble + n - 1) = scale * per_length * p(n);
  }
}

// Cubic Hermite functions and Legendre polynomials integrated twice: orthonormal second derivatives.
void BarBasis::hermite(double xi, Point& out) const {
  const double h = 0.5 * length_, x2 = xi * xi, x3 = x2 * xi;
  out.w(1) = 0.25 * (2.0 - 3.0 * xi + x3), out.w(4) = 0.25 * (2.0 + 3.0 * xi - x3);
  out.w(2) = 0.25 * h * (1.0 - xi - x2 + x3), out.w(5) = 0.25 * h * (-1.0 - xi + x2 + x3);
  out.dw(1) = 0.75 * (x2 - 1.0) / h, out.dw(4) = -out.dw(1);
  out.dw(2) = 0.25 * (-1.0 - 2.0 * xi + 3.0 * x2), out.dw(5) = 0.25 * (-1.0 + 2.0 * xi + 3.0 * x2);
  out.ddw(1) = 1.5 * xi / (h * h), out.ddw(4) = -out.ddw(1);
  out.ddw(2) = 0.5 * (-1.0 + 3.0 * xi) / h, out.ddw(5) = 0.5 * (1.0 + 3.0 * xi) / h;
  const Index first = out.w.size() - in_series_ - bubbles_;
  const VectorXd p = legendre(bubbles_ + 3, xi);
  for (int k = 0; k < bubbles_; ++k) {
    const int n = k + 2;
    const double scale = std::sqrt(n + 0.5);
    const auto integral = [&](int m) { return (p(m + 1) - p(m - 1)) / (2.0 * m + 1.0); };
    out.w(first + k) = scale * (integral(n + 1) - integral(n - 1)) / (2.0 * n + 1.0);
    out.dw(first + k) = scale * integral(n) / h;
    out.ddw(first + k) = scale * p(n) / (h * h);
  }
}

// After turn and dturn are those of w_b.
void BarBasis::add_shear(double xi, Point& out) const {
  const Index first = out.w.size() - in_series_;
  const double per_length = 2.0 / length_, scale_0 = std::sqrt(0.5);
  out.w(first) = scale_0 * (1.0 + xi - 2.0 * out.w(4));
  out.dw(first) = scale_0 * (per_length - 2.0 * out.dw(4));
  out.turn(first) = -2.0 * scale_0 * out.turn(4), out.dturn(first) = -2.0 * scale_0 * out.dturn(4);
  const VectorXd p = legendre(in_series_ + 1, xi);
  for (int n = 1; n < in_series_; ++n) {
    const double scale = std::sqrt(n + 0.5);
    out.w(first + n) = scale * (p(n + 1) - p(n - 1)) / (2.0 * n + 1.0);
    out.dw(first + n) = scale * per_length * p(n);
  }
}

BarBasis::Point BarBasis::at(double s) const {
  const double xi = 2.0 * s - 1.0;
  Point out;
  for (VectorXd* v : {&out.u, &out.du, &out.w, &out.dw, &out.ddw, &out.turn, &out.dturn}) *v = VectorXd::Zero(size());
  linear(xi, 0, 3, axial_ ? 6 : -1, out.u, out.du);
  if (shear_) {
    linear(xi, 1, 4, size() - 2 * bubbles_, out.w, out.dw);
    linear(xi, 2, 5, size() - bubbles_, out.turn, out.dturn);
  } else {
    hermite(xi, out);
    out.turn = out.dw;
    out.dturn = out.ddw;
    if (in_series_ > 0) add_shear(xi, out);
  }
  return out;
}

GaussRule gauss_rule(int n) {
  GaussRule out{VectorXd(n), VectorXd(n)};
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 0.0;
    for (int step = 0; step < 100; ++step) {
      const VectorXd p = legendre(n, x);
      slope = n * (x * p(n) - p(n - 1)) / (x * x - 1.0);
      const double change = p(n) / slope;
      x -= change;
      if (std::abs(change) < 1e-15) break;
    }
    out.at(i) = 0.5 * (1.0 + x);
    out.weight(i) = 1.0 / ((1.0 - x * x) * slope * slope);
  }
  return out;
}

}  // namespace core::structure
