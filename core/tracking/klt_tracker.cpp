#include "core/tracking/klt_tracker.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace core {

namespace {

// Below this the normal matrix of a patch has no second direction (OpenCV's minEigThreshold, per pixel and grey^2).
constexpr double kLeastEigenvalue = 1e-4;

// Rounding to 8 bits alone leaves this mean absolute difference between two images of one texture.
constexpr double kLeastResidual = 0.25;

// sqrt(trace(G^-1) / 2): px of standard deviation per axis for one grey level of noise in the difference of the images;
// G sums the gradient's outer product over the window.
double texture_sigma(const cv::Mat& gray, cv::Point2f centre, int window_px) {
  cv::Mat patch, du, dv;
  cv::getRectSubPix(gray, cv::Size(window_px + 2, window_px + 2), centre, patch, CV_32F);
  const cv::Rect inner(1, 1, window_px, window_px);
  cv::Scharr(patch, du, CV_32F, 1, 0, 1.0 / 32.0);
  cv::Scharr(patch, dv, CV_32F, 0, 1, 1.0 / 32.0);
  const double uu = du(inner).dot(du(inner));
  const double vv = dv(inner).dot(dv(inner));
  const double uv = du(inner).dot(dv(inner));
  const double determinant = uu * vv - uv * uv;
  return determinant > 1e-9 * uu * vv ? std::sqrt(0.5 * (uu + vv) / determinant) : 1.0;
}

}  // namespace

KltTracker::KltTracker(const KltConfig& config)
    : config_(config),
      criteria_(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, config.max_iterations, config.epsilon_px) {}

void KltTracker::set_keyframe(const cv::Mat& gray, const std::vector<cv::Point2f>& points) {
  keyframe_points_ = points;
  cv::buildOpticalFlowPyramid(gray, keyframe_pyramid_, cv::Size(config_.window_px, config_.window_px), config_.pyramid_levels,
                              true, cv::BORDER_REFLECT_101, cv::BORDER_CONSTANT, false);
  const std::size_t n = points.size();
  forward_.resize(n);
  backward_.resize(n);
  forward_found_.resize(n);
  backward_found_.resize(n);
  residual_.resize(n);
  backward_residual_.resize(n);
  sigma_per_residual_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    // Gaussian noise: standard deviation = mean absolute difference * sqrt(pi / 2).
    sigma_per_residual_[i] = std::sqrt(std::numbers::pi / 2.0) * texture_sigma(gray, points[i], config_.window_px);
  }
}

bool KltTracker::track(const cv::Mat& gray, const std::vector<cv::Point2f>& predicted, std::vector<KltPoint>& out) noexcept {
  out.resize(keyframe_points_.size());
  if (keyframe_points_.empty()) return true;
  try {
    const cv::Size window(config_.window_px, config_.window_px);
    cv::buildOpticalFlowPyramid(gray, pyramid_, window, config_.pyramid_levels, true, cv::BORDER_REFLECT_101,
                                cv::BORDER_CONSTANT, false);
    std::copy(predicted.begin(), predicted.end(), forward_.begin());
    cv::calcOpticalFlowPyrLK(keyframe_pyramid_, pyramid_, keyframe_points_, forward_, forward_found_, residual_, window,
                             config_.pyramid_levels, criteria_, cv::OPTFLOW_USE_INITIAL_FLOW, kLeastEigenvalue);
    check_backward(predicted);
  } catch (...) {  // cv::Exception or bad_alloc: the caller counts the frame as lost
    return false;
  }
  report(out);
  return true;
}

// The way back starts as far from the keyframe point as the way there ended from its prediction: a point that slipped
// onto a neighbour does not find home by being put there.
void KltTracker::check_backward(const std::vector<cv::Point2f>& predicted) {
  for (std::size_t i = 0; i < forward_.size(); ++i) backward_[i] = keyframe_points_[i] + (forward_[i] - predicted[i]);
  cv::calcOpticalFlowPyrLK(pyramid_, keyframe_pyramid_, forward_, backward_, backward_found_, backward_residual_,
                           cv::Size(config_.window_px, config_.window_px), config_.pyramid_levels, criteria_,
                           cv::OPTFLOW_USE_INITIAL_FLOW, kLeastEigenvalue);
}

void KltTracker::report(std::vector<KltPoint>& out) const noexcept {
  for (std::size_t i = 0; i < out.size(); ++i) {
    const cv::Point2f miss = backward_[i] - keyframe_points_[i];
    const double miss_px = std::hypot(static_cast<double>(miss.x), static_cast<double>(miss.y));
    out[i].position = forward_[i];
    out[i].sigma_px = sigma_per_residual_[i] * std::max<double>(static_cast<double>(residual_[i]), kLeastResidual);
    out[i].seen = forward_found_[i] != 0 && backward_found_[i] != 0 && miss_px <= config_.forward_backward_px &&
                  std::isfinite(forward_[i].x) && std::isfinite(forward_[i].y);
  }
}

}  // namespace core
