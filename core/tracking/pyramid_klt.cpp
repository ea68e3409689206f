#include "core/tracking/pyramid_klt.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace core {

namespace {

// Smallest eigenvalue of a patch's normal matrix (OpenCV's minEigThreshold, per pixel and grey^2).
constexpr double kLeastEigenvalue = 1e-4;

// Pyramid levels above the full image, for points within some 6 px of their prediction.
constexpr int kNearLevels = 1;

// Mean absolute difference of two images of one texture caused by rounding to 8 bits alone.
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

PyramidKlt::PyramidKlt(const PyramidKltConfig& config)
    : config_(config),
      criteria_(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, config.max_iterations, config.epsilon_px) {}

void PyramidKlt::set_keyframe(const cv::Mat& gray, const std::vector<cv::Point2f>& points) {
  keyframe_points_ = points;
  keyframe_size_ = gray.size();
  cv::buildOpticalFlowPyramid(gray, keyframe_pyramid_, cv::Size(config_.window_px, config_.window_px),
                              config_.pyramid_levels, true, cv::BORDER_REFLECT_101, cv::BORDER_CONSTANT, false);
  sigma_per_residual_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    // Gaussian noise: standard deviation = mean absolute difference * sqrt(pi / 2).
    sigma_per_residual_[i] = std::sqrt(std::numbers::pi / 2.0) * texture_sigma(gray, points[i], config_.window_px);
  }
  near_.origin = points;
  near_.index.resize(points.size());
  std::iota(near_.index.begin(), near_.index.end(), std::size_t{0});
  for (Pass* pass : {&near_, &far_}) {
    for (auto* list : {&pass->origin, &pass->start, &pass->forward, &pass->backward}) list->reserve(points.size());
    pass->index.reserve(points.size());
  }
}

bool PyramidKlt::track(const cv::Mat& gray, const std::vector<cv::Point2f>& predicted,
                       std::vector<TrackedPoint>& out) noexcept {
  try {
    out.resize(keyframe_points_.size());
    if (keyframe_points_.empty()) return true;
    // OpenCV does not return when it builds the pyramid of an empty image.
    if (gray.size() != keyframe_size_ || gray.type() != CV_8UC1) return false;
    cv::buildOpticalFlowPyramid(gray, pyramid_, cv::Size(config_.window_px, config_.window_px), config_.pyramid_levels,
                                true, cv::BORDER_REFLECT_101, cv::BORDER_CONSTANT, false);
    near_.start.assign(predicted.begin(), predicted.end());
    run(near_, std::min(kNearLevels, config_.pyramid_levels));
    report(near_, out);
    gather_lost(predicted, out);
    run(far_, config_.pyramid_levels);
    report(far_, out);
  } catch (...) {  // cv::Exception or bad_alloc: the caller counts the frame as lost
    return false;
  }
  return true;
}

void PyramidKlt::gather_lost(const std::vector<cv::Point2f>& predicted, const std::vector<TrackedPoint>& out) {
  far_.origin.clear();
  far_.start.clear();
  far_.index.clear();
  if (config_.pyramid_levels <= kNearLevels) return;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i].seen) continue;
    far_.origin.push_back(keyframe_points_[i]);
    far_.start.push_back(predicted[i]);
    far_.index.push_back(i);
  }
}

// Backward tracking starts as far from the keyframe point as forward tracking ended from its prediction: otherwise a
// point that slipped onto a neighbour would start at its correct position.
void PyramidKlt::run(Pass& pass, int levels) {
  if (pass.origin.empty()) return;
  const cv::Size window(config_.window_px, config_.window_px);
  pass.forward = pass.start;
  cv::calcOpticalFlowPyrLK(keyframe_pyramid_, pyramid_, pass.origin, pass.forward, pass.forward_found, pass.residual,
                           window, levels, criteria_, cv::OPTFLOW_USE_INITIAL_FLOW, kLeastEigenvalue);
  pass.backward.resize(pass.origin.size());
  for (std::size_t i = 0; i < pass.origin.size(); ++i)
    pass.backward[i] = pass.origin[i] + (pass.forward[i] - pass.start[i]);
  cv::calcOpticalFlowPyrLK(pyramid_, keyframe_pyramid_, pass.forward, pass.backward, pass.backward_found,
                           pass.backward_residual, window, levels, criteria_, cv::OPTFLOW_USE_INITIAL_FLOW,
                           kLeastEigenvalue);
}

void PyramidKlt::report(const Pass& pass, std::vector<TrackedPoint>& out) const noexcept {
  for (std::size_t k = 0; k < pass.origin.size(); ++k) {
    TrackedPoint& point = out[pass.index[k]];
    const cv::Point2f miss = pass.backward[k] - pass.origin[k];
    const double miss_px = std::hypot(static_cast<double>(miss.x), static_cast<double>(miss.y));
    point.position = pass.forward[k];
    point.sigma_px =
        sigma_per_residual_[pass.index[k]] * std::max(static_cast<double>(pass.residual[k]), kLeastResidual);
    point.seen = pass.forward_found[k] != 0 && pass.backward_found[k] != 0 && miss_px <= config_.forward_backward_px &&
                 std::isfinite(pass.forward[k].x) && std::isfinite(pass.forward[k].y);
  }
}

}  // namespace core
