#pragma once

#include <cmath>
#include <filesystem>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

#include "tests/support/test_clip.h"

namespace tests {

// A textured surface that sways at 3 Hz, 128 x 96 px at 25 fps: tracked and analysed within a second.
inline cv::Mat swaying_image(int frame, int width_px = 128, int height_px = 96) {
  cv::RNG random(11);
  cv::Mat texture(height_px + 40, width_px + 40, CV_32FC1), still, shifted, image;
  random.fill(texture, cv::RNG::NORMAL, 0.0, 1.0);
  cv::GaussianBlur(texture, still, {}, 2.0);
  const double t_s = frame / 25.0;
  const double u =
      1.5 * std::sin(2.0 * std::numbers::pi * 3.0 * t_s) + 0.4 * std::sin(2.0 * std::numbers::pi * 1.1 * t_s);
  const cv::Matx23d shift(1.0, 0.0, u - 20.0, 0.0, 1.0, -20.0);
  cv::warpAffine(still, shifted, shift, {width_px, height_px}, cv::INTER_CUBIC);
  shifted.convertTo(image, CV_8UC1, 250.0, 128.0);
  return image;
}

inline void write_swaying_clip(const std::filesystem::path& path, int n_frames, double rate_hz = 25.0) {
  const std::string extension = path.extension().string();
  const int codec =
      extension == ".mp4" ? cv::VideoWriter::fourcc('m', 'p', '4', 'v') : cv::VideoWriter::fourcc('M', 'J', 'P', 'G');
  cv::VideoWriter writer(path.string(), cv::CAP_FFMPEG, codec, rate_hz, {128, 96});
  if (!writer.isOpened()) throw std::runtime_error("cannot write " + path.string());
  for (int frame = 0; frame < n_frames; ++frame) {
    cv::Mat bgr;
    cv::cvtColor(swaying_image(frame), bgr, cv::COLOR_GRAY2BGR);
    writer.write(bgr);
  }
}

// The same image in another pixel type: 16 bits a channel, or with four channels.
inline cv::Mat swaying_image_of(int type, int frame) {
  cv::Mat image;
  swaying_image(frame).convertTo(image, CV_MAT_DEPTH(type), CV_MAT_DEPTH(type) == CV_16U ? 257.0 : 1.0);
  if (CV_MAT_CN(type) == 4) cv::cvtColor(image, image, cv::COLOR_GRAY2BGRA);
  return image;
}

// frame_000.png, ... of any image made from the frame number.
template <class Make>
inline void write_images(const std::filesystem::path& folder, int n_frames, Make make) {
  std::filesystem::create_directories(folder);
  for (int frame = 0; frame < n_frames; ++frame) {
    const std::string number = std::to_string(1000 + frame).substr(1);
    test_support::write_image(folder / ("frame_" + number + ".png"), make(frame));
  }
}

}  // namespace tests
