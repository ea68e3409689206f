#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace core {

struct KltConfig {
  int window_px = 21;
  int pyramid_levels = 4;          // above the full image
  int max_iterations = 30;
  double epsilon_px = 0.003;       // stop when a step is shorter
  double forward_backward_px = 0.5;  // a point tracked there and back must return this near
};

struct KltPoint {
  cv::Point2f position;            // in the current image
  double sigma_px = 0.0;           // standard deviation per axis, from the residual and the texture (METHOD section 2)
  bool seen = false;
};

// Pyramidal Lucas-Kanade tracking (Bouguet 2001, OpenCV's implementation) of points of a keyframe in later images:
// always against the keyframe, never frame to frame, so errors do not add up to drift.
// One thread. After the first image nothing of ours allocates; OpenCV's own routine does.
class KltTracker {
 public:
  explicit KltTracker(const KltConfig& config);

  // The template image; `points` are tracked from now on.
  void set_keyframe(const cv::Mat& gray, const std::vector<cv::Point2f>& points);

  // predicted: where each point is expected (same order as in set_keyframe). Returns false when OpenCV failed.
  [[nodiscard]] bool track(const cv::Mat& gray, const std::vector<cv::Point2f>& predicted, std::vector<KltPoint>& out) noexcept;

  [[nodiscard]] const std::vector<cv::Point2f>& keyframe_points() const noexcept { return keyframe_points_; }

 private:
  void check_backward(const std::vector<cv::Point2f>& predicted);
  void report(std::vector<KltPoint>& out) const noexcept;

  KltConfig config_;
  cv::TermCriteria criteria_;
  std::vector<cv::Mat> keyframe_pyramid_, pyramid_;
  std::vector<cv::Point2f> keyframe_points_, forward_, backward_;
  std::vector<unsigned char> forward_found_, backward_found_;
  std::vector<float> residual_, backward_residual_;  // mean absolute grey difference over the window
  std::vector<double> sigma_per_residual_;           // px per grey level of that residual
};

}  // namespace core
