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

// One writer thread, one reader thread, N slots built once. Lock-free: both ends only ever load the other's index.
// Slots are borrowed in place at both ends, so an item is written and read where it lies and nothing is copied.
// Indices grow without wrapping (64 bit); each end counts its slot along beside them, which spares a division. The
// opposite index is cached (as in rigtorp's SPSCQueue): the shared line is touched only when the cached value says full
// or empty. What an end keeps for itself lies beside its index, on one line: a line more for each end was slower in
// most runs of tests/bench/ring_speed.cpp.
template <class T>
class SpscRing {
 public:
  // Every slot starts as a copy of `prototype`: size its buffers there, and the run path never allocates.
  SpscRing(std::size_t n_slots, const T& prototype) : slots_(n_slots, prototype) { assert(n_slots > 0); }
  SpscRing(const SpscRing&) = delete;
  SpscRing& operator=(const SpscRing&) = delete;

  // Set-up only: who is nudged when an item is published / a slot is given back. May stay null.
  void set_reader_wakeup(Wakeup* wakeup) noexcept { reader_wakeup_ = wakeup; }
  void set_writer_wakeup(Wakeup* wakeup) noexcept { writer_wakeup_ = wakeup; }

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

  // What one end alone reads and writes.
  struct End {
    std::uint64_t cached_opposite_index = 0;
    std::size_t slot = 0;  // = own index % N

    void advance(std::size_t n_slots) noexcept { slot = slot + 1 == n_slots ? 0 : slot + 1; }
  };

  std::vector<T> slots_;
  Wakeup* reader_wakeup_ = nullptr;
  Wakeup* writer_wakeup_ = nullptr;
  // Release by the writer in publish(), acquire by the reader in front(): the slot's contents travel with it.
  alignas(kCacheLineBytes) std::atomic<std::uint64_t> write_index_{0};
  std::atomic<bool> closed_{false};  // release in close(), acquire in finished(): after the last publish
  // Release by the reader in pop(), acquire by the writer in try_claim(): the reader's last look at the slot is over.
  End writer_end_;
  alignas(kCacheLineBytes) std::atomic<std::uint64_t> read_index_{0};
  End reader_end_;
};

// Held by the producing stage only.
template <class T>
class RingWriter {
 public:
  explicit RingWriter(SpscRing<T>& ring) noexcept : ring_(&ring) {}

  // Next free slot, nullptr when full. Claiming twice without publish gives the same slot.
  [[nodiscard]] T* try_claim() noexcept {
    const std::uint64_t index = ring_->write_index_.load(std::memory_order_relaxed);  // only we write it
    auto& own = ring_->writer_end_;
    if (index - own.cached_opposite_index >= ring_->slots_.size()) {
      own.cached_opposite_index = ring_->read_index_.load(std::memory_order_acquire);
      if (index - own.cached_opposite_index >= ring_->slots_.size()) return nullptr;
    }
    return &ring_->slots_[own.slot];
  }

  // Hands the claimed slot over and nudges the reader.
  void publish() noexcept {
    const std::uint64_t index = ring_->write_index_.load(std::memory_order_relaxed);
    assert(index - ring_->read_index_.load(std::memory_order_relaxed) < ring_->slots_.size());
    ring_->writer_end_.advance(ring_->slots_.size());
    ring_->write_index_.store(index + 1, std::memory_order_release);
    if (ring_->reader_wakeup_ != nullptr) ring_->reader_wakeup_->nudge();
  }

  // No further item will come. What is in the ring is still read.
  void close() noexcept {
    ring_->closed_.store(true, std::memory_order_release);
    if (ring_->reader_wakeup_ != nullptr) ring_->reader_wakeup_->nudge();
  }

 private:
  SpscRing<T>* ring_;
};

// Held by the consuming stage only.
template <class T>
class RingReader {
 public:
  explicit RingReader(SpscRing<T>& ring) noexcept : ring_(&ring) {}

  // Oldest item, nullptr when empty. Valid until pop().
  [[nodiscard]] const T* front() noexcept {
    const std::uint64_t index = ring_->read_index_.load(std::memory_order_relaxed);  // only we write it
    auto& own = ring_->reader_end_;
    if (index == own.cached_opposite_index) {
      own.cached_opposite_index = ring_->write_index_.load(std::memory_order_acquire);
      if (index == own.cached_opposite_index) return nullptr;
    }
    return &ring_->slots_[own.slot];
  }

  // Gives the slot back and nudges the writer. Only after front() returned an item.
  void pop() noexcept {
    const std::uint64_t index = ring_->read_index_.load(std::memory_order_relaxed);
    assert(index != ring_->reader_end_.cached_opposite_index);
    ring_->reader_end_.advance(ring_->slots_.size());
    ring_->read_index_.store(index + 1, std::memory_order_release);
    if (ring_->writer_wakeup_ != nullptr) ring_->writer_wakeup_->nudge();
  }

  // True when the writer has closed and every item was read. The order of the two looks matters: closed first, so that
  // an item published just before close() is seen.
  [[nodiscard]] bool finished() noexcept {
    return ring_->closed_.load(std::memory_order_acquire) && front() == nullptr;
  }

  [[nodiscard]] std::size_t depth() const noexcept { return ring_->depth(); }
  [[nodiscard]] std::size_t n_slots() const noexcept { return ring_->n_slots(); }

 private:
  SpscRing<T>* ring_;
};

}  // namespace rt
