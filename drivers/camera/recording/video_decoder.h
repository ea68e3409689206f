#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "drivers/camera/recording/container.h"
#include "drivers/camera/recording/decoder_memory.h"

namespace drivers {

enum class DecodeStatus : std::uint8_t { kPicture, kDamaged, kEnd };

// The pictures of a container's video in the order in which they are shown, decoded on as many threads as the machine
// has processors, or on as many as fit in its memory (of a live sender: only parts of one picture at a time, which
// delays none). Each packet that does not decode, and each picture of which the decoder had to invent a part, is one
// kDamaged.
class VideoDecoder {
 public:
  VideoDecoder(const std::string& path, int most_mb);  // throws std::runtime_error
  VideoDecoder(Container container, int most_mb);      // likewise

  VideoDecoder(const VideoDecoder&) = delete;
  VideoDecoder& operator=(const VideoDecoder&) = delete;

  [[nodiscard]] DecodeStatus next() noexcept;
  [[nodiscard]] const AVFrame& picture() const noexcept { return *picture_; }  // after kPicture, until the next call
  [[nodiscard]] const Container& container() const noexcept { return container_; }
  // After kEnd: why it came before the end of the video, with file and remedy; empty: it did not.
  [[nodiscard]] std::string fault() const;

 private:
  // Of the stream, as far as it is known.
  struct Prediction {
    int n_references = 0;  // pictures that others are predicted from
    int n_delayed = 0;     // pictures decoded before the one that is shown first
  };
  void open_codec(int n_most_threads, const Prediction& prediction);
  void decode_beginning() noexcept;
  [[nodiscard]] bool feed() noexcept;  // false: that packet was damaged

  Container container_;
  int most_mb_;
  std::unique_ptr<DecoderMemory> memory_;  // outlives codec_ and picture_
  AvHandle<AVCodecContext> codec_;
  AvHandle<AVPacket> packet_;
  AvHandle<AVFrame> picture_;
  bool packet_waits_ = false;
  bool draining_ = false;
  int n_errors_in_a_row_ = 0;
};

}  // namespace drivers
