#pragma once

#include <cstdint>
#include <string>

#include "drivers/camera/recording/container.h"

namespace drivers {

enum class DecodeStatus : std::uint8_t { kPicture, kDamaged, kEnd };

// The pictures of a container's video in the order in which they are shown, decoded on as many threads as the machine
// has processors (of a live sender: only parts of one picture at a time, which delays none). Each packet that does not
// decode, and each picture of which the decoder had to invent a part, is one kDamaged.
class VideoDecoder {
 public:
  explicit VideoDecoder(const std::string& path);  // throws std::runtime_error
  explicit VideoDecoder(Container container);      // likewise

  [[nodiscard]] DecodeStatus next() noexcept;
  [[nodiscard]] const AVFrame& picture() const noexcept { return *picture_; }  // after kPicture, until the next call
  [[nodiscard]] const Container& container() const noexcept { return container_; }

 private:
  [[nodiscard]] bool feed() noexcept;  // false: that packet was damaged

  Container container_;
  AvHandle<AVCodecContext> codec_;
  AvHandle<AVPacket> packet_;
  AvHandle<AVFrame> picture_;
  bool packet_waits_ = false;
  bool draining_ = false;
  int n_errors_in_a_row_ = 0;
};

}  // namespace drivers
