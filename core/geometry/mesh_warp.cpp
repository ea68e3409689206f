#include "core/geometry/mesh_warp.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <utility>

namespace core {
namespace {

constexpr int kIterations = 12;  // kMostStrain^12 = 0.002 of the largest shift remains

bool is_sound(const WarpPart& part) {
  const double sum = part.left + part.top + part.right + part.bottom + std::abs(part.swing_u) + std::abs(part.swing_v);
  return std::isfinite(sum) && part.left < part.right && part.top < part.bottom;
}

double distance_to(const WarpPart& part, const Vector2& at) noexcept {
  const double u = std::max({part.left - at.u, at.u - part.right, 0.0});
  const double v = std::max({part.top - at.v, at.v - part.bottom, 0.0});
  return length(u, v);
}

}  // namespace

MeshWarp::MeshWarp(int width_px, int height_px, std::vector<WarpPart> parts)
    : width_px_(width_px), height_px_(height_px), parts_(std::move(parts)) {
  if (width_px < 2 || height_px < 2 || parts_.empty() || !std::all_of(parts_.begin(), parts_.end(), is_sound))
    throw std::invalid_argument("a warp needs an image and parts with an area and finite swings");
  rest_weight_ = std::pow(kReachShare * std::max(width_px, height_px), -3.0);
  for (int y = 0; y < height_px; y += kCellPx) {
    for (int x = 0; x < width_px; x += kCellPx) {
      const Vector2 here{1.0 * x, 1.0 * y};
      std::complex<double> v, v_right, v_below;
      const std::complex<double> u = swing(here, v);
      const std::complex<double> u_right = swing({here.u + kCellPx, here.v}, v_right);
      const std::complex<double> u_below = swing({here.u, here.v + kCellPx}, v_below);
      const double right = std::sqrt(std::norm(u_right - u) + std::norm(v_right - v));
      const double below = std::sqrt(std::norm(u_below - u) + std::norm(v_below - v));
      strain_ = std::max({strain_, right / kCellPx, below / kCellPx});
    }
  }
}

std::complex<double> MeshWarp::swing(const Vector2& at, std::complex<double>& v) const noexcept {
  std::complex<double> u = v = 0.0;
  double sum = rest_weight_;
  for (const WarpPart& part : parts_) {
    const double distance = distance_to(part, at);
    if (distance <= 0.0) return v = part.swing_v, part.swing_u;
    const double weight = 1.0 / (distance * distance * distance);
    u += weight * part.swing_u, v += weight * part.swing_v;
    sum += weight;
  }
  v /= sum;
  return u / sum;
}

Vector2 MeshWarp::shift(const Vector2& at, double phase) const noexcept {
  std::complex<double> v;
  const std::complex<double> u = swing(at, v), turn = std::polar(1.0, phase);
  return {(u * turn).real(), (v * turn).real()};
}

cv::Mat MeshWarp::draw(const cv::Mat& gray, double phase) const {
  const int n_columns = (width_px_ - 1) / kCellPx + 2, n_rows = (height_px_ - 1) / kCellPx + 2;
  cv::Mat nodes(n_rows, n_columns, CV_32FC2);
  for (int row = 0; row < n_rows; ++row) {
    for (int column = 0; column < n_columns; ++column) {
      const Vector2 to{1.0 * column * kCellPx, 1.0 * row * kCellPx};
      Vector2 from = to;  // from + shift(from) = to
      for (int i = 0; i < kIterations; ++i) {
        const Vector2 by = shift(from, phase);
        from = {to.u - by.u, to.v - by.v};
      }
      nodes.at<cv::Vec2f>(row, column) = {static_cast<float>(from.u), static_cast<float>(from.v)};
    }
  }
  cv::Mat map(height_px_, width_px_, CV_32FC2), out;
  for (int y = 0; y < height_px_; ++y) {
    const int row = y / kCellPx;
    const float down = static_cast<float>(y % kCellPx) / kCellPx;
    for (int x = 0; x < width_px_; ++x) {
      const int column = x / kCellPx;
      const float along = static_cast<float>(x % kCellPx) / kCellPx;
      const cv::Vec2f upper =
          nodes.at<cv::Vec2f>(row, column) * (1.0F - along) + nodes.at<cv::Vec2f>(row, column + 1) * along;
      const cv::Vec2f lower =
          nodes.at<cv::Vec2f>(row + 1, column) * (1.0F - along) + nodes.at<cv::Vec2f>(row + 1, column + 1) * along;
      map.at<cv::Vec2f>(y, x) = upper * (1.0F - down) + lower * down;
    }
  }
  cv::remap(gray, out, map, cv::noArray(), cv::INTER_LANCZOS4, cv::BORDER_REPLICATE);
  return out;
}

}  // namespace core
