#include "core/geometry/mesh_warp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace core {
namespace {

constexpr int kWarpIterations = 12;       // kMostStrain^12 = 0.002 of the largest shift remains
constexpr double kWarpSettled_px = 1e-4;  // a change below this ends the iteration

bool is_sound(const WarpPart& part) {
  const double sum = part.left + part.top + part.right + part.bottom + std::abs(part.swing_u) + std::abs(part.swing_v);
  return std::isfinite(sum) && part.left < part.right && part.top < part.bottom;
}

// LanczosWeights of Lanczos' kernel of three lobes (Duchon 1979), at 1/1024 px: OpenCV's remap rounds to 1/32 px, which
// a tracker sees in small motions.
constexpr int kLanczosTaps = 6, kLanczosSteps = 1024;
using LanczosWeights = std::array<float, kLanczosTaps>;

const std::vector<LanczosWeights>& lanczos_weights() {
  static const std::vector<LanczosWeights> table = [] {
    const auto kernel = [](double x) {
      const double a = std::numbers::pi * x;
      return std::abs(x) < 1e-9 ? 1.0 : 3.0 * std::sin(a) * std::sin(a / 3.0) / (a * a);
    };
    std::vector<LanczosWeights> out(kLanczosSteps + 1);
    for (int step = 0; step <= kLanczosSteps; ++step) {
      std::array<double, kLanczosTaps> exact{};
      double sum = 0.0;
      for (int k = 0; k < kLanczosTaps; ++k)
        sum += exact[static_cast<std::size_t>(k)] = kernel(k - 2.0 - 1.0 * step / kLanczosSteps);
      for (std::size_t k = 0; k < kLanczosTaps; ++k)
        out[static_cast<std::size_t>(step)][k] = static_cast<float>(exact[k] / sum);
    }
    return out;
  }();
  return table;
}

std::uint8_t sampled(const cv::Mat& gray, const cv::Vec2f& at) {
  const float u = std::clamp(at[0], 0.0F, static_cast<float>(gray.cols - 1));
  const float v = std::clamp(at[1], 0.0F, static_cast<float>(gray.rows - 1));
  const int column = static_cast<int>(u), row = static_cast<int>(v);
  static const std::vector<LanczosWeights>& table = lanczos_weights();
  const auto weights_at = [](float rest) -> const LanczosWeights& {
    return table[static_cast<std::size_t>(std::lround(rest * kLanczosSteps))];
  };
  const LanczosWeights &along = weights_at(u - static_cast<float>(column)),
                       &down = weights_at(v - static_cast<float>(row));
  float sum = 0.0F;
  if (column >= 2 && row >= 2 && column + 3 < gray.cols && row + 3 < gray.rows) {  // nothing to clamp
    for (int i = 0; i < kLanczosTaps; ++i) {
      const auto* line = gray.ptr<std::uint8_t>(row - 2 + i) + column - 2;
      float of_line = 0.0F;
      for (std::size_t k = 0; k < kLanczosTaps; ++k) of_line += along[k] * static_cast<float>(line[k]);
      sum += down[static_cast<std::size_t>(i)] * of_line;
    }
    return static_cast<std::uint8_t>(std::clamp(std::lround(sum), 0L, 255L));
  }
  for (int i = 0; i < kLanczosTaps; ++i) {
    const auto* line = gray.ptr<std::uint8_t>(std::clamp(row - 2 + i, 0, gray.rows - 1));
    float of_line = 0.0F;
    for (int k = 0; k < kLanczosTaps; ++k)
      of_line +=
          along[static_cast<std::size_t>(k)] * static_cast<float>(line[std::clamp(column - 2 + k, 0, gray.cols - 1)]);
    sum += down[static_cast<std::size_t>(i)] * of_line;
  }
  return static_cast<std::uint8_t>(std::clamp(std::lround(sum), 0L, 255L));
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
      for (int i = 0; i < kWarpIterations; ++i) {
        const Vector2 by = shift(from, phase), before = from;
        from = {to.u - by.u, to.v - by.v};
        if (length(from.u - before.u, from.v - before.v) < kWarpSettled_px) break;
      }
      nodes.at<cv::Vec2f>(row, column) = {static_cast<float>(from.u), static_cast<float>(from.v)};
    }
  }
  cv::Mat map(height_px_, width_px_, CV_32FC2);
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
  cv::Mat out(height_px_, width_px_, CV_8UC1);
  for (int y = 0; y < height_px_; ++y) {
    for (int x = 0; x < width_px_; ++x) out.at<std::uint8_t>(y, x) = sampled(gray, map.at<cv::Vec2f>(y, x));
  }
  return out;
}

}  // namespace core
