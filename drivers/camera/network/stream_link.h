#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>

#include "drivers/camera/network/stream_address.h"
#include "drivers/camera/recording/video_decoder.h"

namespace drivers {

// One connection to a sender of live video. One thread; it waits in the constructor and in `next`, both of which end
// soon after `is_cancelled` is set.
class StreamLink {
 public:
  using Patience = std::chrono::milliseconds;

  // Connects and finds the video. Throws std::runtime_error: what the sender did not do within `patience`.
  // decoder_mb: bound on the decoder's memory.
  StreamLink(const StreamAddress& address, int decoder_mb, Patience patience, const std::atomic<bool>& is_cancelled);

  // kEnd: the sender ended, was silent for `patience`, or this was cancelled.
  [[nodiscard]] DecodeStatus next(Patience patience) noexcept;
  [[nodiscard]] const AVFrame& picture() const noexcept { return decoder_.picture(); }
  // Time of the picture on the sender's clock; empty: the sender states none.
  [[nodiscard]] std::optional<std::int64_t> sent_ns() const noexcept;
  // True where a picture is predicted from the ones before, so that a loss damages those after it.
  [[nodiscard]] bool is_predicted() const noexcept { return decoder_.container().coding_block_px() > 0; }
  [[nodiscard]] const Container& container() const noexcept { return decoder_.container(); }

 private:
  struct Wait {  // libavformat asks it from inside its calls
    const std::atomic<bool>* is_cancelled = nullptr;
    std::chrono::steady_clock::time_point until;
  };
  static int is_over(void* wait) noexcept;
  [[nodiscard]] static Container connect(const StreamAddress& address, Wait& wait);

  std::unique_ptr<Wait> wait_;
  VideoDecoder decoder_;
};

}  // namespace drivers
