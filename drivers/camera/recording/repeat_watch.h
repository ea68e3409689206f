#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "core/types/frame.h"

namespace drivers {

// Every eighth row of the last four frames, and how far two of them differ: mean, gray levels.
class FrameChange {
 public:
  void push(const core::Frame& frame);
  // From the frame `older` to the frame `newer`, both counted back from the last one (0). Empty: there is none, or not
  // of one size.
  [[nodiscard]] std::optional<double> between(std::size_t older, std::size_t newer) const;

 private:
  std::deque<std::vector<std::uint8_t>> rows_;  // the last frame first
};

// Recognises frames that repeat the one before. Encoded again a repeat is not the same bit by bit, but it differs by far
// less than noise and motion make any two of the last frames differ: such a frame is a suspect. A noiseless motion that
// turns back between two frames makes them as alike. What comes next decides:
// - a second suspect, or one that follows a repeat: repeats (a smooth motion cannot stay for three frames);
// - otherwise a repeat only if the frames around it differ, from two before to one after, about as much as most frames
//   do: where a motion turns back, these are alike too.
// Where frames hardly differ at all (a still picture without noise) nothing can be known, and none is a repeat. Allocates
// while the first frames come.
class RepeatWatch {
 public:
  enum class Finding : std::uint8_t { kNew, kRepeat, kSuspect };

  // change: from the frame before. After kSuspect, `settle` comes before the next call.
  [[nodiscard]] Finding push(double change);
  // Whether the suspect is a repeat. next_change: from it to the frame after it; around: from two frames before it to
  // that one. Without them (the recording ends there) it is none.
  [[nodiscard]] bool settle(std::optional<double> next_change, std::optional<double> around);

 private:
  [[nodiscard]] bool is_suspect(double change) const;
  [[nodiscard]] double median_change() const;
  void accept(double change);

  std::deque<double> accepted_;
  double suspect_change_ = 0.0;
  bool last_repeated_ = false;
};

// Frames in the order of a film, without those that repeat. A suspect is held back until the frame after it is known.
class RepeatFilter {
 public:
  struct Ready {
    bool held = false;     // the frame held back is new, and comes first: `exchange` brings it
    bool current = false;  // the frame just pushed is new
  };

  // is_known_repeat: the cadence of a rate conversion says so. A suspect's frame is exchanged for another one's memory.
  [[nodiscard]] Ready push(core::Frame& frame, bool is_known_repeat);
  void exchange(core::Frame& frame) noexcept;  // with the frame held
  [[nodiscard]] bool end(core::Frame& frame);  // no more frames: whether one was held, which is new; it is in `frame`
  [[nodiscard]] std::uint64_t n_repeated() const noexcept { return n_repeated_; }

 private:
  FrameChange change_;
  RepeatWatch watch_;
  core::Frame held_;
  bool holds_ = false;
  std::uint64_t n_repeated_ = 0;
};

}  // namespace drivers
