#include "core/tracking/klt/klt_tracker.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
namespace core {

namespace {

constexpr double kLongestStep_px = 3.0;
constexpr double kLeastGain = 0.2, kMostGain = 5.0;
constexpr double kLeastCorrelation = 0.5;
constexpr double kRounding = 1.0 / 12.0;
constexpr double kOfRounding = 0.5;  // steps within what rounding to 8 bits does anyway

bool window_lies_in(const cv::Mat& gray, int u, int v, int radius) noexcept {
  return u >= radius && v >= radius && u + radius < gray.cols && v + radius < gray.rows;
}

}  // namespace

bool is_trackable(const cv::Mat& gray, const Vector2& point, int window_px) {
  KltConfig config;
  config.window_px = window_px;
  KltTracker tracker(config);
  tracker.set_keyframe(gray, {point});
  return tracker.point_template(0).is_trackable;
}

void KltTracker::set_keyframe(const cv::Mat& gray, const std::vector<Vector2>& points) {
  if (gray.empty() || gray.type() != CV_8UC1)
    throw std::invalid_argument("KltTracker: the keyframe is not an 8-bit image");
  if (config_.window_px < 5 || config_.window_px > kWindow)
    throw std::invalid_argument("KltTracker: a window has 5 to 21 px");
  points_.assign(points.size(), {});
  Patch patch;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Point& point = points_[i];
    point.keyframe = points[i];
    if (!std::isfinite(points[i].u) || !std::isfinite(points[i].v)) continue;
    const int u = static_cast<int>(std::lround(std::clamp(points[i].u, -1e6, 1e6)));
    const int v = static_cast<int>(std::lround(std::clamp(points[i].v, -1e6, 1e6)));
    point.u0 = u, point.v0 = v;
    cut_patch(gray, u, v, patch);
    build_template(patch, config_.window_px / 2, 1, point.pattern);
    judge_texture(point);
  }
}

void KltTracker::judge_texture(Point& point) const noexcept {
  const PointTemplate& pattern = point.pattern;
  const double signal = pattern.variance - pattern.noise / pattern.n_averaged;
  const double expected = signal / std::sqrt(std::max(1e-12, pattern.variance * (signal + pattern.noise)));
  point.least_correlation = std::max(kLeastCorrelation, config_.least_correlation * expected);
}

KltPoint KltTracker::find(const cv::Mat& gray, std::size_t i, const Vector2& predicted) noexcept {
  Point& point = points_[i];
  KltPoint out{predicted, 0.0, point.gain, false};
  if (!point.pattern.is_trackable || gray.type() != CV_8UC1) return out;
  const double start_u = predicted.u - point.keyframe.u + point.u0, start_v = predicted.v - point.keyframe.v + point.v0;
  // Also where a prediction is not a number.
  if (!(std::abs(start_u) < 1e6) || !(std::abs(start_v) < 1e6)) return out;
  double u = start_u, v = start_v;
  int cell_u = 0, cell_v = 0;
  const double enough_px =
      std::max(config_.epsilon_px,
               kOfRounding * std::sqrt(kRounding * std::max(point.pattern.variance_u, point.pattern.variance_v)));
  bool is_settled = false;
  window_.begin(gray, point.pattern);
  const auto advance = [&](const Vector2& step) {
    const double length = std::hypot(step.u, step.v) / point.gain;
    const double share = (length > kLongestStep_px ? kLongestStep_px / length : 1.0) / point.gain;
    u -= share * step.u, v -= share * step.v;
    return length;
  };
  for (int k = 0; k < config_.max_iterations && !is_settled; ++k) {
    cell_u = static_cast<int>(std::floor(u)), cell_v = static_cast<int>(std::floor(v));
    if (!window_lies_in(gray, cell_u, cell_v, point.pattern.radius)) return out;
    window_.move_to(cell_u, cell_v, u - cell_u, v - cell_v);
    is_settled = advance(window_.step()) < enough_px;
    if (!(std::hypot(u - start_u, v - start_v) <= config_.reach_px)) return out;
  }
  out.position = {u - point.u0 + point.keyframe.u, v - point.v0 + point.keyframe.v};
  if (!is_settled) return out;
  const TemplateMatch match = window_.match();  // a last step of epsilon away
  if (!(match.correlation >= point.least_correlation) || match.gain < kLeastGain || match.gain > kMostGain) return out;
  const double noise = std::max(kRounding, match.residual / (1.0 + 1.0 / point.pattern.n_averaged));
  out.sigma_px = std::sqrt(0.5 * noise * (point.pattern.variance_u + point.pattern.variance_v)) / match.gain;
  out.gain = point.gain = match.gain;
  out.seen = true;
  return out;
}

}  // namespace core
