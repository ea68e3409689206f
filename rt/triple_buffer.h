#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "rt/cache_line.h"
#include "rt/wakeup.h"

namespace rt {

// Newest value wins; for snapshots, never for samples. One writer thread, one reader thread, neither ever waits.
// Three buffers: the writer owns one, the reader owns one, the third is exchanged. The exchanged word carries a
// "fresh" bit: set by publish(), cleared by refresh().
template <class T>
class TripleBuffer {
 public:
  explicit TripleBuffer(const T& prototype) : buffers_{prototype, prototype, prototype} {}
  TripleBuffer(const TripleBuffer&) = delete;
  TripleBuffer& operator=(const TripleBuffer&) = delete;

  void set_reader_wakeup(Wakeup* wakeup) noexcept { reader_wakeup_ = wakeup; }  // set-up only
  void set_writer_wakeup(Wakeup* wakeup) noexcept { writer_wakeup_ = wakeup; }  // set-up only

  // Writer: fill back(), then publish().
  [[nodiscard]] T& back() noexcept { return buffers_[back_]; }

  // acq_rel: release publishes the buffer just written; acquire makes the reader's last access to the buffer that is
  // returned happen before it is overwritten. Release alone is a race (tests/stress/triple_buffer_stress_test.cpp under
  // TSAN).
  // False: the previous value was never read, and is lost.
  bool publish() noexcept {
    const std::uint32_t old = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel);
    back_ = old & kIndexMask;
    if (reader_wakeup_ != nullptr) reader_wakeup_->nudge();
    return (old & kFresh) == 0;
  }

  // Writer: whether the last published value has been read. A lossless source waits for this before the next publish.
  [[nodiscard]] bool taken() const noexcept { return (middle_.load(std::memory_order_acquire) & kFresh) == 0; }

  // Writer: no further value will come.
  void close() noexcept {
    closed_.store(true, std::memory_order_release);  // partner: finished()
    if (reader_wakeup_ != nullptr) reader_wakeup_->nudge();
  }

  // Reader: takes the newest value, if there is one that it has not read. acq_rel as in publish().
  [[nodiscard]] bool refresh() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    const std::uint32_t old = middle_.exchange(front_, std::memory_order_acq_rel);
    front_ = old & kIndexMask;
    if (writer_wakeup_ != nullptr) writer_wakeup_->nudge();
    return true;
  }
  [[nodiscard]] const T& front() const noexcept { return buffers_[front_]; }

  // Reader: closed and no unread value. closed_ is loaded first, as in RingReader::finished().
  [[nodiscard]] bool finished() const noexcept { return closed_.load(std::memory_order_acquire) && taken(); }

 private:
  static constexpr std::uint32_t kFresh = 4;
  static constexpr std::uint32_t kIndexMask = 3;

  std::array<T, 3> buffers_;
  Wakeup* reader_wakeup_ = nullptr;
  Wakeup* writer_wakeup_ = nullptr;
  alignas(kCacheLineBytes) std::uint32_t back_ = 0;                // used by the writer only
  alignas(kCacheLineBytes) std::atomic<std::uint32_t> middle_{1};  // partners: publish() and refresh()
  std::atomic<bool> closed_{false};
  alignas(kCacheLineBytes) std::uint32_t front_ = 2;  // used by the reader only
};

}  // namespace rt
