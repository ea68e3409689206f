// Compares this project's reader of video with OpenCV's (VideoCapture, then cvtColor): frames decoded to gray per
// second, on the same clip, alternately, and the differences of their gray values.
//   decode_speed CLIP [ROUNDS]
// Prints: frames/s of both (medians over the rounds), their ratio, the share of pixels that differ, the
// largest difference.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "drivers/camera/recording/frame_source.h"

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

core::Frame slot_of(const drivers::FrameSource& source) {
  core::Frame frame;
  frame.pixels.resize(static_cast<std::size_t>(source.info().width_px) *
                      static_cast<std::size_t>(source.info().height_px));
  return frame;
}

double our_rate_hz(const std::string& clip) {
  const auto start = Clock::now();
  const auto source = drivers::open_frame_source(clip);
  core::Frame frame = slot_of(*source);
  std::size_t n = 0;
  while (source->read(frame) == drivers::ReadStatus::kFrame) ++n;
  return static_cast<double>(n) / seconds_since(start);
}

double opencv_rate_hz(const std::string& clip) {
  const auto start = Clock::now();
  cv::VideoCapture capture(clip, cv::CAP_FFMPEG);
  cv::Mat image, gray;
  std::size_t n = 0;
  for (; capture.read(image); ++n) cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
  return static_cast<double>(n) / seconds_since(start);
}

struct Difference {
  std::uint64_t n_pixels = 0, n_differing = 0, n_frames = 0;
  int largest = 0;
};

Difference compare(const std::string& clip) {
  Difference out;
  const auto source = drivers::open_frame_source(clip);
  cv::VideoCapture capture(clip, cv::CAP_FFMPEG);
  core::Frame frame = slot_of(*source);
  cv::Mat image, gray;
  while (source->read(frame) == drivers::ReadStatus::kFrame && capture.read(image)) {
    cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
    ++out.n_frames;
    for (std::size_t i = 0; i < std::min(frame.pixels.size(), gray.total()); ++i) {
      const int off = std::abs(static_cast<int>(frame.pixels[i]) - static_cast<int>(gray.data[i]));
      out.n_differing += off > 0 ? 1 : 0, out.largest = std::max(out.largest, off);
    }
    out.n_pixels += frame.pixels.size();
  }
  return out;
}

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return fmt::print(stderr, "usage: decode_speed CLIP [ROUNDS]\n"), 2;
  const std::string clip = argv[1];
  const int n_rounds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 5;
  try {
    std::vector<double> ours_hz, opencv_hz, ratios;
    for (int round = 0; round < n_rounds; ++round) {
      ours_hz.push_back(our_rate_hz(clip));
      opencv_hz.push_back(opencv_rate_hz(clip));
      ratios.push_back(ours_hz.back() / opencv_hz.back());
    }
    const Difference difference = compare(clip);
    fmt::print("{:.1f} {:.1f} {:.3f} {:.6f} {}\n", median_of(ours_hz), median_of(opencv_hz), median_of(ratios),
               static_cast<double>(difference.n_differing) /
                   static_cast<double>(std::max<std::uint64_t>(1, difference.n_pixels)),
               difference.largest);
  } catch (const std::exception& thrown) {
    fmt::print(stderr, "decode_speed: {}\n", thrown.what());
    return 1;
  }
  return 0;
}
