#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/types/frame.h"

namespace drivers {

struct PacketScan;

// A rate conversion: of `of` frames in a row `shown` are new, at even places, the others repeat the one before. Frame
// k of the file shows picture floor((k shown + phase) / of) of the recording before it was converted.
struct Cadence {
  int shown = 1, of = 1, phase = 0;
  [[nodiscard]] std::uint64_t picture(std::uint64_t frame) const noexcept {
    return (frame * static_cast<std::uint64_t>(shown) + static_cast<std::uint64_t>(phase)) /
           static_cast<std::uint64_t>(of);
  }
  [[nodiscard]] bool repeats(std::uint64_t frame) const noexcept {
    return frame > 0 && picture(frame) == picture(frame - 1);
  }
};

// Mean difference of two frames that follow one another, in gray levels, over every eighth row.
class FrameChange {
 public:
  [[nodiscard]] std::optional<double> since_last(const core::Frame& frame);  // empty: the first frame

 private:
  std::vector<std::uint8_t> last_, now_;
};

// Recognises a frame that repeats the one before: encoded again it is not the same bit by bit, but it differs by far
// less than noise and motion make any two of the last frames differ. Where those hardly differ (a still and noiseless
// picture) nothing can be known, and nothing is called a repeat. Allocates while the first frames come.
class RepeatWatch {
 public:
  [[nodiscard]] bool is_repeat(double change);

 private:
  std::deque<double> accepted_;
};

// The cadence of changes[k], from frame k - 1 to frame k; changes[0] is not used. around[k], where given: the change
// from frame k - 2 to frame k + 1, which tells a repeat from a noiseless motion that turns back. Empty: no regular
// repeats.
[[nodiscard]] std::optional<Cadence> find_cadence(std::span<const double> changes, std::span<const double> around = {});

// The cadence of a video, from its first frames. They are decoded only where the sizes of the packets show that some
// frames hold next to nothing new.
[[nodiscard]] std::optional<Cadence> find_cadence(const std::string& path, const PacketScan& scan);

}  // namespace drivers
