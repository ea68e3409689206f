#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "core/types/frame.h"

namespace drivers {

// Every eighth row of the last four frames, and the mean difference between two of them in gray levels.
class FrameChange {
 public:
  void push(const core::Frame& frame);
  // From the frame `older` to the frame `newer`, both counted backward from the last one (0). Empty: no such frame, or
  // sizes differ.
  [[nodiscard]] std::optional<double> between(std::size_t older, std::size_t newer) const;

 private:
  std::deque<std::vector<std::uint8_t>> rows_;  // the last frame first
};

// Detects frames that repeat the one before. Encoded again, a repeat is not identical bit by bit, but it differs by far
// less than noise and motion make any two of the last frames differ: such a frame is a suspect. Noiseless motion that
// reverses between two frames also makes them alike. The next frame decides:
// - a second suspect, or one that follows a repeat: repeats (a smooth motion cannot stay for three frames);
// - otherwise a repeat only if the frames around it, from two before to one after, differ about as much as most frames
//   do: where motion reverses, these are alike, too.
// Where frames hardly differ at all (a static scene without noise) no repeat can be detected. Allocates
// while the first frames come.
class RepeatWatch {
 public:
  enum class Finding : std::uint8_t { kNew, kRepeat, kSuspect };

  // change: relative to the frame before. After kSuspect, `settle` must be called before the next push.
  [[nodiscard]] Finding push(double change);
  // Whether the suspect is a repeat. next_change: from it to the next frame; around: from two frames before it to the
  // next frame. Without them (end of the recording) it is none.
  [[nodiscard]] bool settle(std::optional<double> next_change, std::optional<double> around);

 private:
  [[nodiscard]] bool is_suspect(double change) const;
  [[nodiscard]] double median_change() const;
  void accept(double change);

  std::deque<double> accepted_;
  double suspect_change_ = 0.0;
  bool last_repeated_ = false;
};

// Passes on frames in order, without repeats. A suspect is held back until the next frame is known.
class RepeatFilter {
 public:
  struct Ready {
    bool held = false;     // the frame held back is new, and comes first: `exchange` returns it
    bool current = false;  // the frame just pushed is new
  };

  // is_known_repeat: by the cadence of a rate conversion. The memory of a held frame is exchanged for another one's.
  [[nodiscard]] Ready push(core::Frame& frame, bool is_known_repeat);
  void exchange(core::Frame& frame) noexcept;  // swaps with the held frame
  [[nodiscard]] bool end(core::Frame& frame);  // no more frames; returns whether a new one was held: it is in `frame`
  [[nodiscard]] std::uint64_t n_repeated() const noexcept { return n_repeated_; }

 private:
  FrameChange change_;
  RepeatWatch watch_;
  core::Frame held_;
  bool holds_ = false;
  std::uint64_t n_repeated_ = 0;
};

}  // namespace drivers
