#include "rt/wakeup.h"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

namespace rt {

namespace {

static_assert(sizeof(std::atomic<std::uint32_t>) == sizeof(std::uint32_t), "the futex word is the atomic itself");

void futex_wait(std::atomic<std::uint32_t>& word, std::uint32_t expected, std::chrono::milliseconds timeout) noexcept {
  timespec relative{};
  relative.tv_sec = timeout.count() / 1000;
  relative.tv_nsec = (timeout.count() % 1000) * 1'000'000;
  syscall(SYS_futex, &word, FUTEX_WAIT_PRIVATE, expected, &relative, nullptr, 0);
}

void futex_wake(std::atomic<std::uint32_t>& word) noexcept {
  syscall(SYS_futex, &word, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
}

}  // namespace

Wakeup::Ticket Wakeup::ticket() const noexcept { return count_.load(std::memory_order_seq_cst); }

// seq_cst on both words: the waiter announces itself and then compares the count (in the kernel); the notifier counts
// and then checks for a sleeper. With weaker orders both may miss each other (store-load reordering) until the timeout.
void Wakeup::wait(Ticket seen, std::chrono::milliseconds timeout) noexcept {
  sleeping_.store(1, std::memory_order_seq_cst);
  if (count_.load(std::memory_order_seq_cst) == seen) futex_wait(count_, seen, timeout);
  sleeping_.store(0, std::memory_order_relaxed);
}

void Wakeup::nudge() noexcept {
  count_.fetch_add(1, std::memory_order_seq_cst);
  if (sleeping_.load(std::memory_order_seq_cst) != 0) futex_wake(count_);
}

}  // namespace rt
