#pragma once

#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rt/cache_line.h"
#include "rt/wakeup.h"

namespace rt {

template <class T>
class RingWriter;
template <class T>
class RingReader;

// One writer thread, one reader thread, N slots built once. Lock-free: each end only loads the other's index.
// Slots are borrowed in place at both ends, so items are written and read in place and never copied.
// Each end keeps what it needs for a step in its handle, which only its thread uses: its index, the corresponding slot
// (a pointer that wraps around: neither division nor mask, for any N), and its limit by the last loaded value of the
// opposite index (as in rigtorp's SPSCQueue). The shared lines are stored to once per item, and loaded only when
// the ring looks full or empty. Indices grow without wrapping (64 bit).
template <class T>
class SpscRing {
 public:
  // Every slot starts as a copy of `prototype`: size its buffers there, and the run path never allocates.
  SpscRing(std::size_t n_slots, const T& prototype) : slots_(n_slots, prototype) { assert(n_slots > 0); }
  SpscRing(const SpscRing&) = delete;
  SpscRing& operator=(const SpscRing&) = delete;

  // Set-up only: which wakeup is notified when an item is published / a slot is given back. May stay null.
  void set_reader_wakeup(Wakeup* wakeup) noexcept { reader_wakeup_ = wakeup; }
  void set_writer_wakeup(Wakeup* wakeup) noexcept { writer_wakeup_ = wakeup; }

  // One of each at a time. A later one continues where the previous one ended.
  [[nodiscard]] RingWriter<T> writer() noexcept { return RingWriter<T>(*this); }
  [[nodiscard]] RingReader<T> reader() noexcept { return RingReader<T>(*this); }

  [[nodiscard]] std::size_t n_slots() const noexcept { return slots_.size(); }
  // Any thread; a snapshot for the status report.
  [[nodiscard]] std::size_t depth() const noexcept {
    const std::uint64_t read = read_index_.load(std::memory_order_relaxed);
    const std::uint64_t written = write_index_.load(std::memory_order_relaxed);
    return written > read ? static_cast<std::size_t>(written - read) : 0;
  }

 private:
  friend class RingWriter<T>;
  friend class RingReader<T>;

  std::vector<T> slots_;
  Wakeup* reader_wakeup_ = nullptr;
  Wakeup* writer_wakeup_ = nullptr;
  // Release by the writer in publish(), acquire by the reader in front(): makes the slot's contents visible.
  alignas(kCacheLineBytes) std::atomic<std::uint64_t> write_index_{0};
  std::atomic<bool> closed_{false};  // release in close(), acquire in finished(): after the last publish
  // Release by the reader in pop(), acquire by the writer in try_claim(): the reader no longer uses the slot.
  alignas(kCacheLineBytes) std::atomic<std::uint64_t> read_index_{0};
};

// Position of one end.
template <class T>
class RingEnd {
 public:
  RingEnd(std::vector<T>& slots, std::uint64_t index, std::uint64_t limit) noexcept
      : index_(index),
        limit_(limit),
        first_(slots.data()),
        end_(first_ + slots.size()),
        slot_(first_ + index % slots.size()) {}

  [[nodiscard]] bool at_limit() const noexcept { return index_ == limit_; }
  void set_limit(std::uint64_t limit) noexcept { limit_ = limit; }
  [[nodiscard]] T* slot() const noexcept { return slot_; }
  [[nodiscard]] std::uint64_t advance() noexcept {  // the new index
    if (++slot_ == end_) slot_ = first_;
    return ++index_;
  }

 private:
  std::uint64_t index_, limit_;  // of the next item; the opposite end has released at least all items below limit_
  T *first_, *end_, *slot_;
};

// Held by the producing stage only.
template <class T>
class RingWriter {
 public:
  explicit RingWriter(SpscRing<T>& ring) noexcept
      : ring_(&ring),
        end_(ring.slots_, ring.write_index_.load(std::memory_order_relaxed),
             ring.read_index_.load(std::memory_order_acquire) + ring.slots_.size()) {}
  RingWriter(RingWriter&&) noexcept = default;
  RingWriter& operator=(RingWriter&&) noexcept = default;

  // Next free slot, nullptr when full. Claiming twice without publish gives the same slot.
  [[nodiscard]] T* try_claim() noexcept {
    if (end_.at_limit()) [[unlikely]] {
      end_.set_limit(ring_->read_index_.load(std::memory_order_acquire) + ring_->slots_.size());
      if (end_.at_limit()) return nullptr;
    }
    return end_.slot();
  }

  // Publishes the claimed slot and wakes the reader.
  void publish() noexcept {
    assert(!end_.at_limit());
    ring_->write_index_.store(end_.advance(), std::memory_order_release);
    if (ring_->reader_wakeup_ != nullptr) ring_->reader_wakeup_->nudge();
  }

  // No further item will come. Items in the ring can still be read.
  void close() noexcept {
    ring_->closed_.store(true, std::memory_order_release);
    if (ring_->reader_wakeup_ != nullptr) ring_->reader_wakeup_->nudge();
  }

 private:
  SpscRing<T>* ring_;
  RingEnd<T> end_;
};

// Held by the consuming stage only.
template <class T>
class RingReader {
 public:
  explicit RingReader(SpscRing<T>& ring) noexcept
      : ring_(&ring),
        end_(ring.slots_, ring.read_index_.load(std::memory_order_relaxed),
             ring.write_index_.load(std::memory_order_acquire)) {}
  RingReader(RingReader&&) noexcept = default;
  RingReader& operator=(RingReader&&) noexcept = default;

  // Oldest item, nullptr when empty. Valid until pop().
  [[nodiscard]] const T* front() noexcept {
    if (end_.at_limit()) [[unlikely]] {
      end_.set_limit(ring_->write_index_.load(std::memory_order_acquire));
      if (end_.at_limit()) return nullptr;
    }
    return end_.slot();
  }

  // Gives the slot back and wakes the writer. Only after front() returned an item.
  void pop() noexcept {
    assert(!end_.at_limit());
    ring_->read_index_.store(end_.advance(), std::memory_order_release);
    if (ring_->writer_wakeup_ != nullptr) ring_->writer_wakeup_->nudge();
  }

  // True when the writer has closed and every item was read. The order of the two loads matters: closed first, so that
  // an item published just before close() is seen.
  [[nodiscard]] bool finished() noexcept {
    return ring_->closed_.load(std::memory_order_acquire) && front() == nullptr;
  }

  [[nodiscard]] std::size_t depth() const noexcept { return ring_->depth(); }
  [[nodiscard]] std::size_t n_slots() const noexcept { return ring_->n_slots(); }

 private:
  SpscRing<T>* ring_;
  RingEnd<T> end_;
};

}  // namespace rt
