#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/camera/recording/av_handles.h"

namespace drivers {

// A sender of live video (network/stream_link.h).
struct LiveSender {
  std::string url, shown;     // for libavformat; for texts
  AVDictionary* options;      // of demuxer and protocols, its lists of allowed names among them; borrowed
  bool in_parts;              // packets are parts of pictures, those of one picture have one time (RTP)
  AVIOInterruptCB interrupt;  // asked while the sender is waited for; true: that call fails
};

// An open video file, or the connection to a live sender, and the one stream of it that is read; all other streams
// (sound, GPMF, timecode, covers) are skipped, whatever the number of their packets in between. Only self-contained
// formats are opened: a play list that names other files or addresses is not accepted as a video.
class Container {
 public:
  // Throws std::runtime_error: what was found in `path` and what to do.
  explicit Container(const std::string& path);
  explicit Container(const LiveSender& sender);  // likewise
  // Selects the data stream with this tag instead of the video, e.g. "gpmd". has_stream() is false if there is none.
  Container(const std::string& path, const char* data_tag);

  // The next packet of the stream, as stored. False at the end of the file; a failed read also ends it (read_fault), an
  // interrupt likewise.
  [[nodiscard]] bool next(AVPacket& packet) noexcept;
  // Why the disk could not be read, with file and remedy; empty: it could.
  [[nodiscard]] std::string read_fault() const;

  [[nodiscard]] bool has_stream() const noexcept { return stream_ != nullptr; }
  [[nodiscard]] bool has_data(const char* tag) const noexcept;  // whether another stream has this tag
  [[nodiscard]] const AVStream& stream() const noexcept { return *stream_; }
  [[nodiscard]] const AVCodec& decoder() const noexcept { return *decoder_; }
  [[nodiscard]] std::string codec_name() const;
  [[nodiscard]] bool is_live() const noexcept { return is_live_; }
  // What to do about a codec that is not decoded here.
  [[nodiscard]] const char* codec_remedy() const noexcept;
  [[nodiscard]] const std::string& name() const noexcept { return path_; }
  // Largest block with one motion vector; 0: every frame is coded by itself.
  [[nodiscard]] int coding_block_px() const noexcept;
  [[nodiscard]] int clockwise_turn_deg() const noexcept;         // 0, 90, 180, 270, as a player rotates the picture
  [[nodiscard]] std::uint64_t promised_frames() const noexcept;  // 0 = not stated
  // Frame rates as the container states them, the most trusted first; empty: it states none.
  [[nodiscard]] std::vector<double> stated_rates_hz() const;
  [[nodiscard]] double tick_s() const noexcept { return av_q2d(stream_->time_base); }
  [[nodiscard]] std::string other_streams() const;  // in words, e.g. "audio aac, data"; empty: none
  [[nodiscard]] std::uint64_t n_bytes_read() const noexcept;

 private:
  [[nodiscard]] bool read(AVPacket& packet) noexcept;
  [[nodiscard]] bool append(AVPacket& packet) noexcept;  // the part ahead
  void choose_stream();
  void discard_others() noexcept;
  [[nodiscard]] bool may_be_the_film(const AVStream& stream) const noexcept;

  std::string path_;
  bool is_live_ = false;
  AvHandle<AVPacket> ahead_;  // of a stream in parts: the part that was read last
  AvHandle<AVFormatContext> format_;
  AVStream* stream_ = nullptr;        // of format_
  const AVCodec* decoder_ = nullptr;  // static
  int read_error_ = 0;
};

}  // namespace drivers
