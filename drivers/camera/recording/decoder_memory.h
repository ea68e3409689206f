#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "drivers/camera/recording/av_handles.h"

namespace drivers {

// Bound on the memory of the pictures that a decoder holds at one time: reference pictures, pictures that other threads
// decode, and what the codec stores beside each. A decoder's callbacks count it, from any of its threads.
class DecoderMemory {
 public:
  explicit DecoderMemory(int most_mb) noexcept : most_bytes_(std::int64_t{most_mb} * 1'000'000) {}
  DecoderMemory(const DecoderMemory&) = delete;
  DecoderMemory& operator=(const DecoderMemory&) = delete;

  // Before avcodec_open2: the number of threads for which there is room, and counting from now on. The codec must not
  // outlive this object. n_references: pictures that the stream predicts from, 0 = not known.
  [[nodiscard]] int watch(AVCodecContext& codec, int most_threads, int n_references);

  // As the decoder announced with its first picture; 0: none was begun.
  [[nodiscard]] int n_references() const noexcept { return n_references_.load(std::memory_order_relaxed); }

  // True since a picture was refused because it did not fit.
  [[nodiscard]] bool is_exceeded() const noexcept { return n_needed_bytes_.load(std::memory_order_relaxed) != 0; }
  // What was needed and what to do.
  [[nodiscard]] std::string words(const AVCodecContext& codec) const;

 private:
  static int get_buffer(AVCodecContext* codec, AVFrame* picture, int flags) noexcept;
  static void put_back(void* count, std::uint8_t* data) noexcept;
  [[nodiscard]] std::int64_t bytes_of(const AVCodecContext& codec, int width_px, int height_px) const noexcept;
  void refuse(std::int64_t n_needed_bytes) noexcept;

  std::int64_t most_bytes_;
  int n_threads_ = 1;  // pictures decoded at a time
  std::atomic<int> n_references_{0};
  std::atomic<std::int64_t> n_held_bytes_{0};
  std::atomic<std::int64_t> n_needed_bytes_{0};  // 0: all fitted so far
};

}  // namespace drivers
