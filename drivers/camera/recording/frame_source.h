#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/types/frame.h"
#include "drivers/camera/camera_kind.h"
#include "drivers/camera/recording/packet_scan.h"

namespace drivers {

enum class ReadStatus : std::uint8_t { kFrame, kEnd, kFault };

// Properties stated by a recording, checked on its first (folder: and last) frame only.
struct SourceInfo {
  int width_px = 0;  // as delivered, after rotation
  int height_px = 0;
  double rate_hz = 0.0;                      // as stated by the container, unchecked: may be 0, NaN or absurd
  bool has_rate = false;                     // false: an image folder
  std::uint64_t frame_count = 0;             // found in the file, or files in the folder; 0 = unknown
  std::uint64_t promised_frames = 0;         // by the container; 0 = not stated
  std::vector<double> stated_rates_hz{};     // by the container, the most trusted first
  std::shared_ptr<const PacketScan> scan{};  // null: an image folder
  bool holds_gpmf = false;                   // a stream of GoPro's metadata is beside the video
  int turned_clockwise_deg = 0;              // rotation of a delivered image against the sensor's: 0, 90, 180, 270
  int coding_block_px = 0;                   // as in core::CameraInfo
  int decoder_mb = kDecoderMb;               // bound under which it was opened
  std::string description;
};

// Losses of a recording so far.
struct SourceTrouble {
  std::uint64_t n_damaged = 0;       // frames that did not decode completely: left out
  std::uint64_t n_after_damage = 0;  // delivered, but predicted from a damaged frame: up to the next key frame
};

// Frames of a recording one after another. Constructed and read by one thread at a time.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  [[nodiscard]] virtual const SourceInfo& info() const noexcept = 0;
  // Fills pixels only; `out.pixels` is already sized.
  [[nodiscard]] virtual ReadStatus read(core::Frame& out) noexcept = 0;
  // Position in the file of the frame last read, from 0; frames that were left out are counted.
  [[nodiscard]] virtual std::uint64_t index() const noexcept = 0;
  [[nodiscard]] virtual SourceTrouble trouble() const noexcept { return {}; }
  [[nodiscard]] virtual const std::string& error() const noexcept = 0;  // after kFault
  // Whether more than `n` frames decode. Slow (decodes separately from `read`): only if the stated count is doubtful.
  [[nodiscard]] virtual bool has_more_frames_than(std::uint64_t n) const = 0;
};

constexpr int kMinImagePx = 32;  // smaller than this no tracking window with a pyramid level fits

// A video file or a folder of images. Throws DeviceMissing when there is nothing at `path`, std::runtime_error when
// it cannot be used: names the file, what was found and what to do.
[[nodiscard]] std::unique_ptr<FrameSource> open_frame_source(const std::string& path, int decoder_mb = kDecoderMb);

// Direction of the sensor's readout in an image rotated clockwise by a multiple of 90 degrees.
[[nodiscard]] core::ReadoutDirection turn_clockwise(core::ReadoutDirection direction, int degrees) noexcept;

// Throws std::runtime_error if an image of that size is too small to be tracked.
void require_usable_size(const std::string& file, int width_px, int height_px);

// Stops OpenCV's and FFmpeg's messages on stderr, which this program's own messages replace. For the whole process,
// process, once.
void silence_media_libraries();

}  // namespace drivers
