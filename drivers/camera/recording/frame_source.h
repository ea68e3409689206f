#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/types/frame.h"

namespace drivers {

enum class ReadStatus : std::uint8_t { kFrame, kEnd, kFault };

// What a recording says about itself, checked as far as its first (folder: and last) frame.
struct SourceInfo {
  int width_px = 0;  // as delivered, after rotation
  int height_px = 0;
  double rate_hz = 0.0;           // as the container says, unjudged: may be 0, NaN or absurd
  bool has_rate = false;          // false: an image folder
  std::uint64_t frame_count = 0;  // as promised by the container, or files in the folder; 0 = unknown
  int turned_clockwise_deg = 0;   // by how much a delivered image is turned against the sensor's: 0, 90, 180, 270
  std::string description;
};

// Frames of a recording one after another. Constructed and read by one thread at a time.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  [[nodiscard]] virtual const SourceInfo& info() const noexcept = 0;
  // Fills pixels only; `out.pixels` is already sized.
  [[nodiscard]] virtual ReadStatus read(core::Frame& out) noexcept = 0;
  [[nodiscard]] virtual const std::string& error() const noexcept = 0;  // after kFault
  // Whether more than `n` frames really decode. Slow (decodes them apart from `read`): for a doubtful promise only.
  [[nodiscard]] virtual bool has_more_frames_than(std::uint64_t n) const = 0;
};

constexpr int kMinImagePx = 32;  // smaller than this no tracking window with a pyramid level fits

// A video file or a folder of images. Throws DeviceMissing when there is nothing at `path`, std::runtime_error when
// what is there cannot be used: names the file, what was found and what to do.
[[nodiscard]] std::unique_ptr<FrameSource> open_frame_source(const std::string& path);

// How the sensor's readout runs in an image turned clockwise by a multiple of 90 degrees.
[[nodiscard]] core::ReadoutDirection turn_clockwise(core::ReadoutDirection direction, int degrees) noexcept;

// Throws std::runtime_error when an image of that size is too small to be tracked.
void require_usable_size(const std::string& file, int width_px, int height_px);

// OpenCV and FFmpeg write to stderr what they dislike about a file; our own messages say it better. For the whole
// process, once; an OPENCV_FFMPEG_LOGLEVEL already in the environment is left alone.
void silence_media_libraries();

}  // namespace drivers
