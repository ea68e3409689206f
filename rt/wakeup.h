#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

#include "rt/cache_line.h"

namespace rt {

// The one place where a stage sleeps. Any thread notifies, one thread waits. A notification between `ticket` and `wait`
// is never lost: the wait then returns at once. No system call while nobody sleeps, no allocation, no lock (a futex on
// Linux).
//
//   const auto ticket = wakeup.ticket();
//   if (nothing_to_do()) wakeup.wait(ticket, 100ms);
class Wakeup {
 public:
  using Ticket = std::uint32_t;

  [[nodiscard]] Ticket ticket() const noexcept;
  void wait(Ticket seen, std::chrono::milliseconds timeout) noexcept;
  void nudge() noexcept;

 private:
  alignas(kCacheLineBytes) std::atomic<std::uint32_t> count_{0};  // notifications so far; partner: count_ in wait()
  std::atomic<std::uint32_t> sleeping_{0};                        // 1 while the waiter may be in the kernel
};

}  // namespace rt
