#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace app {

// Which frames are kept while tracking cannot process all of them: from some frame on every n-th, at equal spacing.
// Capture writes, any thread reads; the reader of a frame from a ring finds that frame's entry (release in change(),
// acquire in at()).
class ThinningSchedule {
 public:
  static constexpr std::size_t kMaxChanges = 16;
  struct Change {
    std::uint64_t first_sequence = 0;  // this frame and every `stride`-th after it are kept
    std::uint32_t stride = 1;

    [[nodiscard]] bool keeps(std::uint64_t sequence) const noexcept {
      return (sequence - first_sequence) % stride == 0;
    }
  };

  // Capture only; false when there is no room for another change.
  bool change(Change change) noexcept {
    const std::size_t n = n_.load(std::memory_order_relaxed);
    if (n == kMaxChanges) return false;
    changes_[n] = change;
    n_.store(n + 1, std::memory_order_release);
    return true;
  }

  [[nodiscard]] Change at(std::uint64_t sequence) const noexcept {
    std::size_t i = n_.load(std::memory_order_acquire) - 1;
    while (i > 0 && changes_[i].first_sequence > sequence) --i;
    return changes_[i];
  }
  [[nodiscard]] Change newest() const noexcept { return changes_[n_.load(std::memory_order_acquire) - 1]; }

 private:
  std::array<Change, kMaxChanges> changes_{};  // the first: every frame
  std::atomic<std::size_t> n_{1};
};

// Distinguishes sustained overload from a burst: two consecutive windows of two seconds in which more than a tenth of
// the frames found no room. The new stride leaves tracking a tenth of its time. Used by capture only.
class OverloadWatch {
 public:
  explicit OverloadWatch(double rate_hz) noexcept : rate_hz_(rate_hz) { begin(1); }

  // Call for every frame that was to be kept. Returns the stride that tracking can process; 0: unchanged.
  [[nodiscard]] std::uint32_t add(bool dropped) noexcept;

 private:
  void begin(std::uint32_t stride) noexcept;

  double rate_hz_;
  std::uint32_t stride_ = 1;
  std::uint64_t window_ = 0;  // frames
  std::uint64_t n_ = 0, n_dropped_ = 0, n_dropped_before_ = 0;
  bool heavy_before_ = false;
};

}  // namespace app
