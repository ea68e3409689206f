#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <stdexcept>
#include <string>
#include <vector>

// Small clips and image folders for tests, written under ::testing::TempDir().
namespace test_support {

namespace fs = std::filesystem;

// An empty folder of the running test.
inline fs::path fresh_folder() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(test->test_suite_name()) + "." + test->name();
  std::replace(name.begin(), name.end(), '/', '_');  // parameterised tests
  const fs::path folder = fs::path(::testing::TempDir()) / "hovermodal" / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

// Gray picture of blocks whose brightness encodes the frame number: every frame differs, even after lossy coding.
inline cv::Mat clip_image(int frame, int width_px, int height_px) {
  cv::Mat image(height_px, width_px, CV_8UC1);
  for (int v = 0; v < height_px; ++v) {
    for (int u = 0; u < width_px; ++u) {
      const int block = (u / 16 + v / 16) % 2;
      image.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(block * 80 + 10 + 7 * (frame % 20));
    }
  }
  return image;
}

struct ClipShape {
  int n_frames = 20;
  int width_px = 64;
  int height_px = 48;
  double rate_hz = 25.0;
};

// MPEG-4 in .mp4, MJPG in .avi (at most 600 fps) or .mov, by the extension of `path`.
inline void write_clip(const fs::path& path, const ClipShape& shape = {}) {
  const std::string extension = path.extension().string();
  const char* const tag = extension == ".mp4" ? "mp4v" : extension == ".mov" ? "jpeg" : "MJPG";
  const int codec = cv::VideoWriter::fourcc(tag[0], tag[1], tag[2], tag[3]);
  cv::VideoWriter writer(path.string(), cv::CAP_FFMPEG, codec, shape.rate_hz, {shape.width_px, shape.height_px});
  if (!writer.isOpened()) throw std::runtime_error("cannot write " + path.string());
  for (int frame = 0; frame < shape.n_frames; ++frame) {
    cv::Mat bgr;
    cv::cvtColor(clip_image(frame, shape.width_px, shape.height_px), bgr, cv::COLOR_GRAY2BGR);
    writer.write(bgr);
  }
}

inline void write_image(const fs::path& path, const cv::Mat& image) {
  if (!cv::imwrite(path.string(), image)) throw std::runtime_error("cannot write " + path.string());
}

// frame_0.png, frame_1.png, ... without leading zeros.
inline void write_image_folder(const fs::path& folder, const ClipShape& shape = {}) {
  fs::create_directories(folder);
  for (int frame = 0; frame < shape.n_frames; ++frame) {
    write_image(folder / ("frame_" + std::to_string(frame) + ".png"),
                clip_image(frame, shape.width_px, shape.height_px));
  }
}

// Encoded images one after the other: a stream that states neither its length nor its rate.
inline std::string image_stream(const std::string& extension, const std::vector<cv::Mat>& images) {
  std::string stream;
  for (const cv::Mat& image : images) {
    std::vector<std::uint8_t> encoded;
    cv::imencode(extension, image, encoded);
    stream.append(encoded.begin(), encoded.end());
  }
  return stream;
}

inline void write_text(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

inline std::string read_bytes(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

inline void keep_first_bytes(const fs::path& path, double share) {
  fs::resize_file(path, static_cast<std::uintmax_t>(share * static_cast<double>(fs::file_size(path))));
}

// Rewrites the display matrix in an MP4's track header: players turn the picture clockwise by 0, 90, 180 or 270 deg.
inline void set_mp4_rotation(const fs::path& path, int clockwise_deg) {
  std::string bytes = read_bytes(path);
  const std::size_t box = bytes.find("tkhd");
  if (box == std::string::npos) throw std::runtime_error("no track header in " + path.string());
  const std::size_t matrix = box + 4 + 40;  // version 0 of the box: 40 bytes before the matrix
  const int cosine = clockwise_deg == 0 ? 1 : clockwise_deg == 180 ? -1 : 0;
  const int sine = clockwise_deg == 90 ? 1 : clockwise_deg == 270 ? -1 : 0;
  const std::vector<int> rows = {cosine, sine, 0, -sine, cosine, 0};  // 16.16 fixed point, big endian
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto value = static_cast<std::uint32_t>(rows[i] * 65536);
    for (std::size_t byte = 0; byte < 4; ++byte) {
      bytes[matrix + 4 * i + byte] = static_cast<char>((value >> (24 - 8 * byte)) & 0xff);
    }
  }
  write_text(path, bytes);
}

// `frame,t_s` with the given times.
inline void write_timestamps(const fs::path& path, const std::vector<double>& times_s) {
  std::ofstream out(path);
  out.precision(12);
  out << "frame,t_s\n";
  for (std::size_t i = 0; i < times_s.size(); ++i) out << i << ',' << times_s[i] << '\n';
}

}  // namespace test_support
