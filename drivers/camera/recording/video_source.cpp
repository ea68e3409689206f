#include "drivers/camera/recording/video_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <opencv2/core.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "drivers/camera/recording/image_folder_source.h"
#include "drivers/camera/recording/libav_versions.h"
#include "drivers/camera/recording/picture_luma.h"
#include "drivers/camera/recording/video_decoder.h"

namespace drivers {

namespace fs = std::filesystem;

namespace {

constexpr double kManyBits = 2.0;  // per pixel: more code the image itself rather than blocks that move

// Whether one of the first packets is marked as encrypted; the container may name any codec. A decoder may take what is
// encrypted for pictures.
bool is_encrypted(const std::string& path) {
  constexpr int kFirstPackets = 16;
  Container container(path);
  const AvHandle<AVPacket> packet(av_packet_alloc());
  for (int i = 0; i < kFirstPackets && packet && container.next(*packet); ++i) {
    const bool found = av_packet_get_side_data(packet.get(), AV_PKT_DATA_ENCRYPTION_INFO, nullptr) != nullptr;
    av_packet_unref(packet.get());
    if (found) return true;
  }
  return false;
}

class VideoSource final : public FrameSource {
 public:
  VideoSource(const std::string& path, int decoder_mb) : path_(path), decoder_(path, decoder_mb) {
    info_.decoder_mb = decoder_mb;
    info_.scan = std::make_shared<const PacketScan>(scan_packets(path));
    info_.turned_clockwise_deg = decoder_.container().clockwise_turn_deg();
    take_first_picture();
    describe();
  }

  [[nodiscard]] const SourceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] const std::string& error() const noexcept override { return error_; }
  [[nodiscard]] std::uint64_t index() const noexcept override { return index_; }
  [[nodiscard]] SourceTrouble trouble() const noexcept override { return trouble_; }

  ReadStatus read(core::Frame& out) noexcept override {
    const bool is_there = first_is_waiting_ || next_picture();
    first_is_waiting_ = false;
    if (!is_there) {
      note_end();
      return end_of_file();
    }
    note_index();
    try {
      error_ = change(out);
      if (error_.empty()) return convert(out), ReadStatus::kFrame;
    } catch (const std::exception& thrown) {
      error_ = fmt::format("{}: frame {}: {}", path_, index_, thrown.what());
    }
    return ReadStatus::kFault;
  }

  [[nodiscard]] bool has_more_frames_than(std::uint64_t n) const override {
    VideoDecoder counting(path_, info_.decoder_mb);
    for (std::uint64_t i = 0; i <= n;) {
      const DecodeStatus status = counting.next();
      if (status == DecodeStatus::kEnd) return false;
      if (status == DecodeStatus::kPicture) ++i;
    }
    return true;
  }

 private:
  void take_first_picture() {
    const auto refuse = [&](const char* why) {
      throw std::runtime_error(
          fmt::format("{}: opens as a video ({}) but {}", path_, decoder_.container().codec_name(), why));
    };
    if (is_encrypted(path_)) refuse("it is encrypted: decrypt it first");
    if (!next_picture()) {
      if (const std::string fault = decoder_.fault(); !fault.empty()) throw std::runtime_error(fault);
      refuse("not one frame decodes: the file is damaged or its codec is not supported; try to play it with ffplay");
    }
    first_is_waiting_ = true;
    const AVFrame& first = decoder_.picture();
    const std::string unwanted = PictureLuma::unwanted(static_cast<AVPixelFormat>(first.format));
    if (!unwanted.empty()) {
      throw std::runtime_error(fmt::format(
          "{}: video has {}: convert it to 8 bits without alpha: ffmpeg -i IN -pix_fmt yuv420p -crf 12 OUT.mp4", path_,
          unwanted));
    }
    luma_.emplace(first);
    stored_width_px_ = first.width, stored_height_px_ = first.height;
    if (info_.turned_clockwise_deg != 0) stored_.create(first.height, first.width, CV_8UC1);
  }

  void describe() {
    const Container& container = decoder_.container();
    const bool lies_on_its_side = info_.turned_clockwise_deg % 180 != 0;
    info_.width_px = lies_on_its_side ? stored_height_px_ : stored_width_px_;
    info_.height_px = lies_on_its_side ? stored_width_px_ : stored_height_px_;
    require_usable_size(path_, info_.width_px, info_.height_px);
    info_.has_rate = true;
    info_.stated_rates_hz = container.stated_rates_hz();
    info_.rate_hz = info_.stated_rates_hz.empty() ? 0.0 : info_.stated_rates_hz.front();
    info_.holds_gpmf = container.has_data("gpmd");
    info_.promised_frames = container.promised_frames();
    info_.coding_block_px = bits_per_pixel() < kManyBits ? container.coding_block_px() : 0;
    info_.frame_count = info_.scan->complete ? info_.scan->n_packets : info_.promised_frames;
    info_.description = fmt::format(
        "video {} ({}, {} x {} px{}{})", path_, container.codec_name(), info_.width_px, info_.height_px,
        info_.turned_clockwise_deg == 0 ? std::string() : fmt::format(", turned by {} deg", info_.turned_clockwise_deg),
        container.other_streams().empty() ? std::string() : ", beside it " + container.other_streams());
  }

  // Mean over the packets scanned; 0: none.
  [[nodiscard]] double bits_per_pixel() const {
    const std::vector<std::uint32_t>& bytes = info_.scan->bytes;
    if (bytes.empty()) return 0.0;
    const double bits = 8.0 * std::accumulate(bytes.begin(), bytes.end(), 0.0) / static_cast<double>(bytes.size());
    return bits / (static_cast<double>(stored_width_px_) * stored_height_px_);
  }

  // False: the stream has ended. Damaged pictures are counted and skipped.
  bool next_picture() noexcept {
    for (;;) {
      switch (decoder_.next()) {
        case DecodeStatus::kEnd:
          return false;
        case DecodeStatus::kDamaged:
          ++n_bad_packets_;
          since_damage_ = true;
          break;
        case DecodeStatus::kPicture:
          return true;
      }
    }
  }

  // A disk that fails is no end.
  ReadStatus end_of_file() noexcept {
    try {
      error_ = decoder_.fault();
    } catch (const std::bad_alloc&) {
      return ReadStatus::kFault;
    }
    return error_.empty() ? ReadStatus::kEnd : ReadStatus::kFault;
  }

  // Position of the picture in the order of the file. Frames between it and the previous one did not decode.
  void note_index() noexcept {
    const AVFrame& picture = decoder_.picture();
    const std::vector<std::int64_t>& ticks = info_.scan->ticks;
    const std::uint64_t next = n_read_ == 0 ? 0 : index_ + 1;
    std::uint64_t at = next;
    if (!ticks.empty() && picture.best_effort_timestamp != AV_NOPTS_VALUE) {
      const auto begin = ticks.begin() + static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(next, ticks.size()));
      const auto found = std::lower_bound(begin, ticks.end(), picture.best_effort_timestamp);
      if (found != ticks.end() && *found == picture.best_effort_timestamp) {
        at = static_cast<std::uint64_t>(found - ticks.begin());
      }
    } else {
      at += std::exchange(n_bad_packets_, 0);
    }
    if (at > next) trouble_.n_damaged += at - next, since_damage_ = true;
    if (is_key_frame(picture)) since_damage_ = false;
    if (since_damage_) ++trouble_.n_after_damage;
    index_ = at;
    ++n_read_;
  }

  void note_end() noexcept {
    const std::uint64_t next = n_read_ == 0 ? 0 : index_ + 1;
    const std::uint64_t n_frames = info_.scan->complete ? info_.scan->ticks.size() : 0;
    if (n_frames == 0) {
      trouble_.n_damaged += std::exchange(n_bad_packets_, 0);
    } else if (n_frames > next) {
      trouble_.n_damaged += n_frames - next;
      index_ = n_frames - 1;  // at the end again: already counted
    }
  }

  // How the picture differs in format from those before; empty: not at all.
  [[nodiscard]] std::string change(const core::Frame& out) const {
    const AVFrame& picture = decoder_.picture();
    if (picture.width != stored_width_px_ || picture.height != stored_height_px_) {
      return fmt::format(
          "{}: frame {} is {} x {} px, those before are {} x {} px: the picture changes its size in mid-stream; cut "
          "the "
          "clip there and analyse the parts apart: ffmpeg -i IN -t SECONDS -c copy OUT.mp4",
          path_, index_, picture.width, picture.height, stored_width_px_, stored_height_px_);
    }
    if (!luma_->fits(picture))
      return fmt::format("{}: frame {}: its pixel format changes in mid-stream", path_, index_);
    const auto n_pixels = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
    return out.pixels.size() == n_pixels ? std::string() : fmt::format("{}: frame slot of another size", path_);
  }

  void convert(core::Frame& out) {
    out.width_px = info_.width_px;
    out.height_px = info_.height_px;
    if (info_.turned_clockwise_deg == 0) return luma_->read(decoder_.picture(), out.pixels.data());
    luma_->read(decoder_.picture(), stored_.data);
    cv::Mat turned(info_.height_px, info_.width_px, CV_8UC1, out.pixels.data());  // written in place
    cv::rotate(stored_, turned,
               info_.turned_clockwise_deg == 90    ? cv::ROTATE_90_CLOCKWISE
               : info_.turned_clockwise_deg == 180 ? cv::ROTATE_180
                                                   : cv::ROTATE_90_COUNTERCLOCKWISE);
  }

  std::string path_;
  VideoDecoder decoder_;
  std::optional<PictureLuma> luma_;
  cv::Mat stored_;  // picture before rotation
  int stored_width_px_ = 0, stored_height_px_ = 0;
  SourceInfo info_;
  SourceTrouble trouble_;
  std::string error_;
  std::uint64_t n_read_ = 0;
  std::uint64_t index_ = 0;
  std::uint64_t n_bad_packets_ = 0;  // since the last picture; only if the packets carry no times
  bool since_damage_ = false;        // and no key frame has come since
  bool first_is_waiting_ = false;    // the decoder holds the first picture, decoded to learn its size
};

}  // namespace

std::unique_ptr<FrameSource> open_video(const std::string& path, int decoder_mb) {
  if (fs::file_size(path) == 0) {
    throw std::runtime_error(fmt::format("{}: the file is empty (0 bytes): record or copy it again", path));
  }
  if (is_image_file(path)) {
    throw std::runtime_error(
        fmt::format("{}: a single image: name a video, or the folder that holds the images", path));
  }
  return std::make_unique<VideoSource>(path, decoder_mb);
}

}  // namespace drivers
