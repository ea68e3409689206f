// Noise floor of point motion in filmed video, compared with OpenCV: corners of the first frame, each followed by both
// trackers from its last position, window 21 x 21. Of every point and axis the median of the spectral density over
// frequency, which spectral lines do not affect, above a tenth of the rate, where there is no slow motion; of those the
// median over points that neither tracker lost. A tab-separated line per clip:
//   FILE  FRAMES  POINTS  OURS_PX_PER_SQRT_HZ  OPENCV_PX_PER_SQRT_HZ  LOST_BY_US  LOST_BY_OPENCV
// The rate is taken as 1 Hz: only the ratio matters.
//   tracking_noise_floor CLIP...
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "core/linear/median.h"
#include "core/tracking/klt/template_average.h"
#include "core/tracking/point_seeder.h"
#include "tests/support/gray_view.h"

namespace {

using test_support::view;

struct Series {
  std::vector<double> u, v;
  bool is_lost = false;
};

// Of white noise of variance s^2 about s^2 ln 2, the median of a chi-square variable of two degrees over its mean.
double median_density(const std::vector<double>& x) {
  const int n = static_cast<int>(x.size());
  cv::Mat in(1, n, CV_64F), out;
  double mean = 0.0;
  for (const double value : x) mean += value / n;
  for (int k = 0; k < n; ++k)
    in.at<double>(0, k) = (x[static_cast<std::size_t>(k)] - mean) * (0.5 - 0.5 * std::cos(CV_2PI * (k + 0.5) / n));
  cv::dft(in, out, cv::DFT_COMPLEX_OUTPUT);
  std::vector<double> density;
  for (int k = n / 10; k < n / 2; ++k) {
    const auto& c = out.at<cv::Vec2d>(0, k);
    density.push_back((c[0] * c[0] + c[1] * c[1]) / (0.375 * n));
  }
  return core::median(density);
}

double floor_of(const std::vector<Series>& all, const std::vector<Series>& other) {
  std::vector<double> levels;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].is_lost || other[i].is_lost) continue;
    levels.push_back(std::sqrt(median_density(all[i].u)));
    levels.push_back(std::sqrt(median_density(all[i].v)));
  }
  return levels.empty() ? std::nan("") : core::median(levels);
}

std::ptrdiff_t n_lost(const std::vector<Series>& all) {
  return std::count_if(all.begin(), all.end(), [](const Series& s) { return s.is_lost; });
}

int judge(const std::string& file) {
  cv::VideoCapture clip(file);
  cv::Mat frame, gray, keyframe;
  if (!clip.read(frame)) {
    std::fprintf(stderr, "tracking_noise_floor: %s: no frame\n", file.c_str());
    return 1;
  }
  cv::cvtColor(frame, keyframe, cv::COLOR_BGR2GRAY);
  core::SeedConfig seeds;
  seeds.points_per_region = 60;
  const core::Region whole{
      "whole", 16.0, 16.0, keyframe.cols - 32.0, keyframe.rows - 32.0, core::RegionRole::kStructure, 0.0, false};
  std::vector<core::Vector2> points;
  std::vector<cv::Point2f> from;
  for (const cv::Point2f& p : core::seed_points(keyframe, whole, seeds)) {
    const core::Vector2 point{static_cast<double>(p.x), static_cast<double>(p.y)};
    if (!core::is_trackable(view(keyframe), point, core::kWindow)) continue;
    points.push_back(point), from.push_back(p);
  }
  core::KltTracker tracker{core::KltConfig{}};
  tracker.set_keyframe(view(keyframe), points);
  core::TemplateAverage templates(tracker);
  std::vector<Series> ours(points.size()), theirs(points.size());
  std::vector<core::KltPoint> found(points.size());
  std::vector<core::Vector2> last = points;
  std::vector<cv::Point2f> to = from;
  const cv::Size window(core::kWindow, core::kWindow);
  int n_frames = 1;
  for (; clip.read(frame); ++n_frames) {
    cv::cvtColor(frame, gray, cv::COLOR_BGR2GRAY);
    std::vector<unsigned char> status;
    std::vector<float> residual;
    cv::calcOpticalFlowPyrLK(keyframe, gray, from, to, status, residual, window, 3,
                             {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 20, 0.001},
                             cv::OPTFLOW_USE_INITIAL_FLOW);
    for (std::size_t i = 0; i < points.size(); ++i) {
      found[i] = tracker.find(view(gray), i, last[i]);
      ours[i].is_lost = ours[i].is_lost || !found[i].seen;
      if (found[i].seen) last[i] = found[i].position;
      ours[i].u.push_back(last[i].u), ours[i].v.push_back(last[i].v);
      theirs[i].is_lost = theirs[i].is_lost || status[i] == 0;
      theirs[i].u.push_back(static_cast<double>(to[i].x)), theirs[i].v.push_back(static_cast<double>(to[i].y));
    }
    templates.add(view(gray), found, tracker);
  }
  std::printf("%s\t%d\t%zu\t%.5f\t%.5f\t%td\t%td\n", file.substr(file.rfind('/') + 1).c_str(), n_frames, points.size(),
              floor_of(ours, theirs), floor_of(theirs, ours), n_lost(ours), n_lost(theirs));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  int failures = argc < 2 ? 1 : 0;
  for (int i = 1; i < argc; ++i) failures += judge(argv[i]);
  return failures == 0 ? 0 : 1;
}
