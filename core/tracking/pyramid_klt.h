#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace core {

struct PyramidKltConfig {
  int window_px = 21;
  int pyramid_levels = 4;  // levels above the full image
  int max_iterations = 30;
  double epsilon_px = 0.003;         // stop below this step length
  double forward_backward_px = 0.5;  // a point tracked forward and backward must return within this distance
};

struct TrackedPoint {
  cv::Point2f position;   // in the current image
  double sigma_px = 0.0;  // standard deviation per axis, from the residual and the texture
  bool seen = false;
};

// Pyramidal Lucas-Kanade tracking (Bouguet 2001, OpenCV's implementation) of points of a keyframe in later images:
// always against the keyframe, never frame to frame, so errors do not accumulate to drift. Points are first searched
// near their prediction, on the full image and the level above; only points not found there are searched through the
// whole pyramid, because its coarse windows also contain background that moves differently. After the first
// image this code does not allocate; OpenCV's routine does.
class PyramidKlt {
 public:
  explicit PyramidKlt(const PyramidKltConfig& config);

  // Sets the template image; `points` are tracked from now on.
  void set_keyframe(const cv::Mat& gray, const std::vector<cv::Point2f>& points);

  // predicted: expected position of each point (order of set_keyframe). Returns false if OpenCV failed or the image is
  // not 8-bit of the keyframe's size; `out` is then undefined.
  [[nodiscard]] bool track(const cv::Mat& gray, const std::vector<cv::Point2f>& predicted,
                           std::vector<TrackedPoint>& out) noexcept;

  [[nodiscard]] const std::vector<cv::Point2f>& keyframe_points() const noexcept { return keyframe_points_; }

 private:
  // Points being tracked, forward and backward.
  struct Pass {
    std::vector<cv::Point2f> origin, start, forward, backward;
    std::vector<unsigned char> forward_found, backward_found;
    std::vector<float> residual, backward_residual;  // mean absolute grey difference over the window
    std::vector<std::size_t> index;                  // of the keyframe's points
  };

  void run(Pass& pass, int levels);
  void report(const Pass& pass, std::vector<TrackedPoint>& out) const noexcept;
  void gather_lost(const std::vector<cv::Point2f>& predicted, const std::vector<TrackedPoint>& out);

  PyramidKltConfig config_;
  cv::TermCriteria criteria_;
  std::vector<cv::Mat> keyframe_pyramid_, pyramid_;
  cv::Size keyframe_size_;
  std::vector<cv::Point2f> keyframe_points_;
  Pass near_, far_;
  std::vector<double> sigma_per_residual_;  // px per grey level of the residual
};

}  // namespace core
