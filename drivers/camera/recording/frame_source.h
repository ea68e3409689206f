#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/types/frame.h"
#include "drivers/camera/recording/packet_scan.h"

namespace drivers {

enum class ReadStatus : std::uint8_t { kFrame, kEnd, kFault };

// What a recording says about itself, checked as far as its first (folder: and last) frame.
struct SourceInfo {
  int width_px = 0;  // as delivered, after rotation
  int height_px = 0;
  double rate_hz = 0.0;                      // as the container says, unjudged: may be 0, NaN or absurd
  bool has_rate = false;                     // false: an image folder
  std::uint64_t frame_count = 0;             // found in the file, or files in the folder; 0 = unknown
  std::uint64_t promised_frames = 0;         // by the container; 0 = it does not say
  std::vector<double> stated_rates_hz{};     // the container's, the most trusted first
  std::shared_ptr<const PacketScan> scan{};  // null: an image folder
  bool holds_gpmf = false;       // a stream of GoPro's metadata is beside the video
  int turned_clockwise_deg = 0;  // by how much a delivered image is turned against the sensor's: 0, 90, 180, 270
  std::string description;
};

// What a recording lacked so far.
struct SourceTrouble {
  std::uint64_t n_damaged = 0;       // frames that did not decode whole: left out
  std::uint64_t n_after_damage = 0;  // delivered, but predicted from such a frame: up to the next key frame
};

// Frames of a recording one after another. Constructed and read by one thread at a time.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  [[nodiscard]] virtual const SourceInfo& info() const noexcept = 0;
  // Fills pixels only; `out.pixels` is already sized.
  [[nodiscard]] virtual ReadStatus read(core::Frame& out) noexcept = 0;
  // Where in the file's order the frame last read stands, from 0; those that were left out are counted.
  [[nodiscard]] virtual std::uint64_t index() const noexcept = 0;
  [[nodiscard]] virtual SourceTrouble trouble() const noexcept { return {}; }
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
// process, once.
void silence_media_libraries();

}  // namespace drivers
