// Time of the point tracker beside OpenCV's, one thread, same frames, points and starts: 180 points in six regions.
// Medians and minima over the rounds, microseconds. Lines of "what <TAB> ours <TAB> opencv <TAB> ratio":
//   frame 720p | 1080p | 4K   starts 0.1 px off, as a predictor gives. Ours: all points. OpenCV: pyramid of each
//   region's
//                      tight sub-image, once a frame, the keyframe's kept, four levels
//   frame 1080p, 0.7 px off   the same from farther starts
//   ..., whole image's pyramid   OpenCV as most programs use it
//   point              of a frame at 1080p, a point, without the pyramid
//   kernel             the same starts, one level
//   fall-back          a frame in which every region jumped by 60 px, ours only
//   tracking_speed ROUNDS SEED     or   tracking_speed 0 SEED FRAMES: ours only, prints nothing
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/tracking/point_finder.h"
#include "tests/support/gray_view.h"

namespace {

using test_support::view;
constexpr int kRegions = 6, kPerRegion = 30;
constexpr int kJump_px = 60;

// Smoothed noise at twice the resolution: every second pixel forms an image, and the pixels between form the same image
// half a pixel further, so that nothing is interpolated.
cv::Mat fine_texture(int width, int height, std::uint64_t seed) {
  cv::Mat out(2 * height, 2 * width, CV_8UC1);
  cv::RNG random(seed);
  random.fill(out, cv::RNG::UNIFORM, 0, 255);
  cv::GaussianBlur(out, out, {0, 0}, 3.0);
  cv::normalize(out, out, 20, 235, cv::NORM_MINMAX);
  return out;
}

// Moved by so many half pixels; mirrored at the border.
cv::Mat moved(const cv::Mat& fine, int half_u, int half_v) {
  cv::Mat out(fine.rows / 2, fine.cols / 2, CV_8UC1);
  for (int v = 0; v < out.rows; ++v)
    for (int u = 0; u < out.cols; ++u)
      out.at<std::uint8_t>(v, u) =
          fine.at<std::uint8_t>(core::mirrored(2 * v - half_v, fine.rows), core::mirrored(2 * u - half_u, fine.cols));
  return out;
}

struct Scene {
  cv::Mat keyframe, frame, jumped;
  std::vector<core::Vector2> points;
  std::vector<std::uint16_t> region;
  std::vector<cv::Rect> boxes;
};

Scene scene(int width, int height, std::uint64_t seed) {
  Scene s;
  const cv::Mat fine = fine_texture(width, height, seed);
  s.keyframe = moved(fine, 0, 0);
  s.frame = moved(fine, 1, -1);
  s.jumped = moved(fine, 2 * kJump_px, 0);
  for (int r = 0; r < kRegions; ++r) {
    const int top = height * (r + 1) / (kRegions + 1) - 30, left = width / 2 - 100;
    s.boxes.emplace_back(left - 40, top - 40, 280, 140);
    for (int k = 0; k < kPerRegion; ++k) {
      s.points.push_back({left + 20.0 * (k % 10), top + 20.0 * (k / 10)});
      s.region.push_back(static_cast<std::uint16_t>(r));
    }
  }
  return s;
}

// All points last seen at their keyframe position and this motion: they are searched there.
core::RegionFollower follower_at(const Scene& s, const core::Vector2& motion) {
  core::RegionFollower follower({s.frame.cols, s.frame.rows}, s.points, s.region, kRegions);
  core::TrackFrame seen;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    core::TrackPoint& point = seen.points.emplace_back();
    point.region = s.region[i];
    point.u_px = s.points[i].u + motion.u, point.v_px = s.points[i].v + motion.v;
    point.sigma_px = 0.01;
    point.seen = point.inlier = true;
  }
  for (int k = 0; k < 8; ++k) follower.update(seen);
  return follower;
}

// Starts beside the frame's motion of (0.5, -0.5) px.
constexpr core::Vector2 kNear{0.57, -0.43}, kFar{0.0, 0.0};

struct Time {
  double median = 0.0, least = 0.0;
};
Time summary(std::vector<double> all) {
  std::sort(all.begin(), all.end());
  return {all[all.size() / 2], all.front()};
}
double once_us(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
}
Time time_us(int n, const std::function<void()>& work) {
  std::vector<double> all;
  for (int k = 0; k < n; ++k) all.push_back(once_us(work));
  return summary(all);
}
// Alternately, so that a temporarily slower machine affects both.
std::pair<Time, Time> time_both_us(int n, const std::function<void()>& ours, const std::function<void()>& theirs) {
  std::vector<double> a, b;
  for (int k = 0; k < n; ++k) a.push_back(once_us(ours)), b.push_back(once_us(theirs));
  return {summary(a), summary(b)};
}

void print(const char* what, const Time& ours, const Time& theirs, double n = 1.0) {
  std::printf("%s\t%.2f\t%.2f\t%.2f\t%.2f\t%.2f\n", what, ours.median / n, theirs.median / n,
              theirs.median / ours.median, ours.least / n, theirs.least / n);
}

void compare(const char* name, int width, int height, const core::Vector2& start, int n_rounds, std::uint64_t seed) {
  const Scene s = scene(width, height, seed);
  const core::RegionFollower follower = follower_at(s, start);
  core::PointFinder finder({}, view(s.keyframe), s.points, s.region, kRegions);
  int n_seen = 0;
  const auto find_all = [&] { finder.find(view(s.frame), follower); };
  find_all();
  for (const core::KltPoint& p : finder.points()) n_seen += p.seen ? 1 : 0;

  const cv::Size window(core::kWindow, core::kWindow);
  const cv::TermCriteria criteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 20, 0.001);
  constexpr int kLevels = 4;
  std::vector<std::vector<cv::Mat>> keyframes(kRegions), frames(kRegions);
  std::vector<std::vector<cv::Point2f>> from(kRegions);
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    const cv::Rect& box = s.boxes[s.region[i]];
    from[s.region[i]].emplace_back(static_cast<float>(s.points[i].u - box.x),
                                   static_cast<float>(s.points[i].v - box.y));
  }
  const auto pyramids = [&](const cv::Mat& image, std::vector<std::vector<cv::Mat>>& out, int levels) {
    for (int r = 0; r < kRegions; ++r)
      cv::buildOpticalFlowPyramid(image(s.boxes[static_cast<std::size_t>(r)]), out[static_cast<std::size_t>(r)], window,
                                  levels, true, cv::BORDER_REFLECT_101, cv::BORDER_CONSTANT, false);
  };
  const auto track = [&](int levels) {
    std::vector<unsigned char> status;
    std::vector<float> residual;
    for (std::size_t r = 0; r < kRegions; ++r) {
      std::vector<cv::Point2f> to = from[r];
      for (cv::Point2f& p : to) p += cv::Point2f(static_cast<float>(start.u), static_cast<float>(start.v));
      cv::calcOpticalFlowPyrLK(keyframes[r], frames[r], from[r], to, status, residual, window, levels, criteria,
                               cv::OPTFLOW_USE_INITIAL_FLOW);
    }
  };
  pyramids(s.keyframe, keyframes, kLevels);
  pyramids(s.frame, frames, kLevels);
  const auto [of_points, their_points] = time_both_us(n_rounds, find_all, [&] { track(kLevels); });
  const auto [ours, theirs] = time_both_us(n_rounds, find_all, [&] {
    pyramids(s.frame, frames, kLevels);
    track(kLevels);
  });
  // The whole image's pyramid, as most programs do.
  std::vector<cv::Mat> whole;
  const Time whole_pyramid = time_us(std::max(3, n_rounds / 10), [&] {
    cv::buildOpticalFlowPyramid(s.frame, whole, window, kLevels, true, cv::BORDER_REFLECT_101, cv::BORDER_CONSTANT,
                                false);
  });
  print((std::string("frame ") + name).c_str(), ours, theirs);
  print((std::string("frame ") + name + ", whole image's pyramid").c_str(), ours,
        {whole_pyramid.median + their_points.median, whole_pyramid.least + their_points.least});
  if (std::string(name) != "1080p") {
    std::printf("# %s: %d of %zu seen\n", name, n_seen, s.points.size());
    return;
  }
  print("point", of_points, their_points, static_cast<double>(s.points.size()));

  core::KltTracker tracker{core::KltConfig{}};
  tracker.set_keyframe(view(s.keyframe), s.points);
  pyramids(s.keyframe, keyframes, 0);
  pyramids(s.frame, frames, 0);
  const auto [kernel, their_kernel] = time_both_us(
      n_rounds,
      [&] {
        for (std::size_t i = 0; i < s.points.size(); ++i) {
          (void)tracker.find(view(s.frame), i, {s.points[i].u + start.u, s.points[i].v + start.v});
        }
      },
      [&] { track(0); });
  print("kernel", kernel, their_kernel, static_cast<double>(s.points.size()));

  const Time fall_back = time_us(std::max(3, n_rounds / 10), [&] { finder.find(view(s.jumped), follower); });
  int n_found = 0;
  for (const core::KltPoint& p : finder.points()) n_found += p.seen ? 1 : 0;
  std::printf("fall-back\t%.0f\t\t\t%.0f\t\nseen\t%d of %zu, after the jump %d\n", fall_back.median, fall_back.least,
              n_seen, s.points.size(), n_found);
}

// Frames of 180 points and nothing else, to count instructions.
void follow_only(int n_frames, std::uint64_t seed) {
  const Scene s = scene(1920, 1080, seed);
  const core::RegionFollower follower = follower_at(s, kNear);
  core::PointFinder finder({}, view(s.keyframe), s.points, s.region, kRegions);
  for (int k = 0; k < n_frames; ++k) finder.find(view(s.frame), follower);
}

}  // namespace

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  const int n_rounds = argc > 1 ? std::max(3, std::atoi(argv[1])) : 200;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  if (argc > 3) {
    follow_only(std::atoi(argv[3]), seed);
    return 0;
  }
  compare("720p", 1280, 720, kNear, n_rounds, seed);
  compare("1080p", 1920, 1080, kNear, n_rounds, seed);
  compare("1080p, 0.7 px off", 1920, 1080, kFar, n_rounds, seed);
  compare("4K", 3840, 2160, kNear, n_rounds, seed);
}
