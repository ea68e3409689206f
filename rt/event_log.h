#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "rt/clock.h"
#include "rt/spsc_ring.h"

namespace rt {

// An event of a real-time thread: fixed size, so that recording it neither allocates, locks nor waits.
struct Event {
  std::int64_t t_ns = 0;     // CLOCK_MONOTONIC
  const char* what = "";     // a string literal; "{}" stands for the values, in order
  std::int64_t values[2]{};  // unused ones 0
};

// One thread writes, another one reads and prints. A full log drops the newest event and counts it.
class EventLog {
 public:
  explicit EventLog(std::size_t n_events = 256) : ring_(n_events, Event{}) {}

  // Writer. `what` must have static lifetime: a literal.
  void write(const char* what, std::int64_t first = 0, std::int64_t second = 0) noexcept {
    if (Event* slot = writer_.try_claim()) {
      *slot = {monotonic_ns(), what, {first, second}};
      writer_.publish();
    } else {
      n_dropped_.store(n_dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    }
  }

  // Reader: passes every waiting event to `print`, oldest first. Returns their number.
  template <class Print>
  std::size_t drain(Print print) {
    std::size_t n = 0;
    while (const Event* event = reader_.front()) {
      print(*event);
      reader_.pop();
      ++n;
    }
    return n;
  }

  // Any thread; relaxed: independent of other data.
  [[nodiscard]] std::uint64_t n_dropped() const noexcept { return n_dropped_.load(std::memory_order_relaxed); }

 private:
  SpscRing<Event> ring_;
  RingWriter<Event> writer_ = ring_.writer();
  RingReader<Event> reader_ = ring_.reader();
  std::atomic<std::uint64_t> n_dropped_{0};
};

}  // namespace rt
