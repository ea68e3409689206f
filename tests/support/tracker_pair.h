#pragma once

#include <array>
#include <cmath>
#include <opencv2/video/tracking.hpp>
#include <vector>

#include "core/tracking/klt/klt_tracker.h"
#include "tests/support/gray_view.h"

namespace test_support {

// This project's tracker and OpenCV's on the same points of the same images.

inline constexpr int kPairWidth = 420, kPairHeight = 320, kPairBorder = 40, kPairApart = 30;

inline std::vector<core::Vector2> point_grid() {
  std::vector<core::Vector2> points;
  for (int v = kPairBorder; v < kPairHeight - kPairBorder; v += kPairApart)
    for (int u = kPairBorder; u < kPairWidth - kPairBorder; u += kPairApart)
      points.push_back({static_cast<double>(u), static_cast<double>(v)});
  return points;
}

struct Error {
  double u = 0.0, v = 0.0;
  bool seen = false;
};

// Errors of both, for all points, in an image moved by (du, dv). OpenCV: as many iterations as help, one level above 0.
inline std::array<std::vector<Error>, 2> errors(core::KltTracker& tracker, const cv::Mat& keyframe,
                                                const cv::Mat& image, const std::vector<core::Vector2>& points,
                                                double du, double dv, std::vector<double>* stated = nullptr) {
  std::array<std::vector<Error>, 2> out;
  std::vector<cv::Point2f> from, to;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const core::Vector2 start{points[i].u + std::round(du), points[i].v + std::round(dv)};
    const core::KltPoint found = tracker.find(view(image), i, start);
    out[0].push_back({found.position.u - points[i].u - du, found.position.v - points[i].v - dv, found.seen});
    if (stated != nullptr) stated->push_back(found.sigma_px);
    from.emplace_back(static_cast<float>(points[i].u), static_cast<float>(points[i].v));
    to.emplace_back(static_cast<float>(start.u), static_cast<float>(start.v));
  }
  std::vector<unsigned char> status;
  std::vector<float> residual;
  cv::calcOpticalFlowPyrLK(keyframe, image, from, to, status, residual, {core::kWindow, core::kWindow}, 1,
                           {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 20, 0.001}, cv::OPTFLOW_USE_INITIAL_FLOW);
  for (std::size_t i = 0; i < points.size(); ++i)
    out[1].push_back({static_cast<double>(to[i].x) - points[i].u - du, static_cast<double>(to[i].y) - points[i].v - dv,
                      status[i] != 0});
  return out;
}

}  // namespace test_support
