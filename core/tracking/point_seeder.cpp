#include "core/tracking/point_seeder.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace core {

namespace {
constexpr double kHarrisK = 0.04;
constexpr int kHarrisBlockPx = 5;
// A flat patch has Harris responses of rounding noise; a quality relative to the strongest would accept them.
constexpr double kLeastContrast = 2.0;  // grey levels, standard deviation
}  // namespace

std::vector<cv::Point2f> seed_points(const cv::Mat& gray, const Region& region, const SeedConfig& config) {
  const int margin = config.window_px / 2 + 2;
  const cv::Rect image(margin, margin, gray.cols - 2 * margin, gray.rows - 2 * margin);
  const cv::Rect wanted(cvRound(region.u_px), cvRound(region.v_px), cvRound(region.width_px),
                        cvRound(region.height_px));
  const cv::Rect usable = wanted & image;
  if (usable.width < 3 || usable.height < 3) return {};
  const cv::Mat patch = gray(usable);
  cv::Scalar mean, deviation;
  cv::meanStdDev(patch, mean, deviation);
  if (deviation[0] < kLeastContrast) return {};

  std::vector<cv::Point2f> corners;
  cv::goodFeaturesToTrack(patch, corners, config.points_per_region, config.corner_quality, config.min_distance_px,
                          cv::noArray(), kHarrisBlockPx, true, kHarrisK);
  for (cv::Point2f& corner : corners) {
    corner.x += static_cast<float>(usable.x);
    corner.y += static_cast<float>(usable.y);
  }
  return corners;
}

}  // namespace core
