#include "drivers/camera/recording/video_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/videoio.hpp>
#include <stdexcept>

#include "drivers/camera/recording/gray_convert.h"
#include "drivers/camera/recording/image_folder_source.h"

namespace drivers {

namespace fs = std::filesystem;

namespace {

std::string fourcc_text(int code) {
  std::string text;
  for (int shift = 0; shift < 32; shift += 8) {
    const int byte = (code >> shift) & 0xff;
    if (std::isprint(byte) != 0) text += static_cast<char>(byte);
  }
  return text;
}

// OpenCV hands every video over as 8-bit BGR and says nothing of what it threw away. The pixel format's tag tells; for
// big-endian formats FFmpeg writes it backward. Ten and twelve bits (ordinary phone footage, and scaled to full range)
// are let through: their upper eight bits are what we want. Sixteen often hold twelve unscaled, and come out black.
std::string unwanted_pixel_format(int pixel_format_tag) {
  std::string text = fourcc_text(pixel_format_tag);
  for (int order = 0; order < 2; ++order) {
    for (const char* alpha : {"RGBA", "BGRA", "ARGB", "ABGR", "RBA@", "BRA@", "ABR@", "ARB@"}) {
      if (text == alpha) return "an alpha channel";
    }
    if (text.starts_with("Y4") || text.starts_with("Y2") || text.starts_with("G4")) return "an alpha channel";
    const int first = pixel_format_tag & 0xff;
    const int last = (pixel_format_tag >> 24) & 0xff;
    if (text == "Y1" && (first == 16 || last == 16)) return "16 bit gray pixels";
    if (text == "RGB0" || text == "BGR0") return "16 bits per channel";  // '0' is 48: bits per pixel
    std::reverse(text.begin(), text.end());
  }
  return {};
}

// OpenCV 4.6.0 has the sign of the display matrix wrong: it states, and turns by, 270 degrees for 90 (mended in 4.7.0,
// opencv issue 22088). Its own turning is therefore off, and we turn.
int clockwise_turn_deg(const cv::VideoCapture& capture) {
  const int stated = static_cast<int>(capture.get(cv::CAP_PROP_ORIENTATION_META));
  if (stated != 90 && stated != 180 && stated != 270) return 0;  // OpenCV turns by quarter turns only, and so do we
  const bool sign_is_wrong = cv::getVersionMajor() == 4 && cv::getVersionMinor() == 6;
  return sign_is_wrong ? 360 - stated : stated;
}

cv::VideoCapture open_capture(const std::string& path) {
  // Absolute: a name such as "concat:a" must not be taken for one of FFmpeg's protocols.
  cv::VideoCapture capture(fs::absolute(path).string(), cv::CAP_FFMPEG);
  if (capture.isOpened()) capture.set(cv::CAP_PROP_ORIENTATION_AUTO, 0.0);
  return capture;
}

class VideoSource final : public FrameSource {
 public:
  explicit VideoSource(const std::string& path) : path_(path), capture_(open_capture(path)) {
    if (!capture_.isOpened()) {
      throw std::runtime_error(
          fmt::format("{}: not a video that can be opened: an unknown format, or an MP4 whose index is missing because "
                      "the recording was cut off; if ffplay shows it, convert it: ffmpeg -i IN -crf 12 OUT.mp4; else "
                      "record it again",
                      path));
    }
    const int codec_tag = static_cast<int>(capture_.get(cv::CAP_PROP_FOURCC));
    if (fourcc_text(codec_tag) == "ansi") {  // FFmpeg draws any text file as if on a terminal
      throw std::runtime_error(fmt::format("{}: a text file, not a video: check camera.source", path));
    }
    const std::string unwanted = unwanted_pixel_format(static_cast<int>(capture_.get(cv::CAP_PROP_CODEC_PIXEL_FORMAT)));
    if (!unwanted.empty()) {
      throw std::runtime_error(fmt::format(
          "{}: video has {}: convert it to 8 bits without alpha: ffmpeg -i IN -pix_fmt yuv420p -crf 12 OUT.mp4", path,
          unwanted));
    }
    info_.turned_clockwise_deg = clockwise_turn_deg(capture_);
    describe(codec_tag);
  }

  [[nodiscard]] const SourceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] const std::string& error() const noexcept override { return error_; }

  ReadStatus read(core::Frame& out) noexcept override {
    if (!first_is_waiting_ && !read_image()) return error_.empty() ? ReadStatus::kEnd : ReadStatus::kFault;
    first_is_waiting_ = false;
    const GrayStatus status = image_.cols == info_.width_px ? convert_to_gray(image_, out) : GrayStatus::kSizeMismatch;
    if (status == GrayStatus::kOk) {
      ++n_read_;
      return ReadStatus::kFrame;
    }
    error_ = fmt::format("{}: frame {} ({} x {} px): {}", path_, n_read_, image_.cols, image_.rows, to_string(status));
    return ReadStatus::kFault;
  }

  [[nodiscard]] bool has_more_frames_than(std::uint64_t n) const override {
    cv::VideoCapture counting = open_capture(path_);
    for (std::uint64_t i = 0; i <= n; ++i) {
      if (!counting.grab()) return false;
    }
    return true;
  }

 private:
  void describe(int codec_tag) {
    if (!read_image()) {
      throw std::runtime_error(fmt::format(
          "{}: opens as a video ({}) but not one frame decodes: the file is damaged or its codec is not supported; "
          "try to play it with ffplay",
          path_, fourcc_text(codec_tag)));
    }
    first_is_waiting_ = true;
    require_usable_size(path_, image_.cols, image_.rows);
    info_.width_px = image_.cols;
    info_.height_px = image_.rows;
    info_.has_rate = true;
    info_.rate_hz = capture_.get(cv::CAP_PROP_FPS);
    const double promised = capture_.get(cv::CAP_PROP_FRAME_COUNT);
    if (promised >= 1.0 && promised < 1e12) info_.frame_count = static_cast<std::uint64_t>(promised);
    info_.description =
        fmt::format("video {} ({}, {} x {} px{})", path_, fourcc_text(codec_tag), info_.width_px, info_.height_px,
                    info_.turned_clockwise_deg == 0 ? std::string()
                                                    : fmt::format(", turned by {} deg", info_.turned_clockwise_deg));
  }

  bool read_image() noexcept {
    try {
      if (!capture_.read(stored_) || stored_.empty()) return false;
      switch (info_.turned_clockwise_deg) {
        case 90:
          cv::rotate(stored_, image_, cv::ROTATE_90_CLOCKWISE);
          break;
        case 180:
          cv::rotate(stored_, image_, cv::ROTATE_180);
          break;
        case 270:
          cv::rotate(stored_, image_, cv::ROTATE_90_COUNTERCLOCKWISE);
          break;
        default:
          image_ = stored_;  // shares the pixels
      }
      return true;
    } catch (const std::exception& thrown) {
      error_ = fmt::format("{}: frame {}: {}", path_, n_read_, thrown.what());
      return false;
    }
  }

  std::string path_;
  cv::VideoCapture capture_;
  cv::Mat stored_;  // as decoded
  cv::Mat image_;   // as delivered
  SourceInfo info_;
  std::string error_;
  std::uint64_t n_read_ = 0;
  bool first_is_waiting_ = false;  // image_ holds the first frame, decoded to learn the size
};

}  // namespace

std::unique_ptr<FrameSource> open_video(const std::string& path) {
  if (fs::file_size(path) == 0) {
    throw std::runtime_error(fmt::format("{}: the file is empty (0 bytes): record or copy it again", path));
  }
  if (is_image_file(path)) {
    throw std::runtime_error(
        fmt::format("{}: a single image: name a video, or the folder that holds the images", path));
  }
  return std::make_unique<VideoSource>(path);
}

}  // namespace drivers
