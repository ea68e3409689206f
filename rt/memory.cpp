#include "rt/memory.h"

#include <alloca.h>
#include <malloc.h>
#include <pthread.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <system_error>

namespace rt {

namespace {

// Stack below the calling frame. Less than the thread's stack size, which includes its thread-local data.
std::size_t stack_left() noexcept {
  pthread_attr_t attributes;
  if (pthread_getattr_np(pthread_self(), &attributes) != 0) return 0;
  void* lowest = nullptr;
  std::size_t size = 0;
  pthread_attr_getstack(&attributes, &lowest, &size);
  pthread_attr_destroy(&attributes);
  const auto here = reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0));
  const auto end = reinterpret_cast<std::uintptr_t>(lowest);
  return here > end ? here - end : 0;
}

// Both callers run before other threads allocate.
void set_heap(int parameter, int value) noexcept {
  mallopt(parameter, value);  // NOLINT(concurrency-mt-unsafe)
}

}  // namespace

std::string lock_memory() {
  if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return {};
  return std::string("locking memory refused (") + std::system_category().message(errno) +
         "): grant CAP_IPC_LOCK or raise RLIMIT_MEMLOCK";
}

void keep_freed_memory() noexcept {
  set_heap(M_TRIM_THRESHOLD, -1);
  set_heap(M_MMAP_MAX, 0);
}

// Setting them also ends their adaptation: one freed block of 32 MB would leave all smaller ones to the heap, and 64 MB
// of free memory at its end. Smaller limits than these cost page faults.
void give_back_large_blocks() noexcept {
  constexpr int kLargeBytes = 1 << 19, kSpareBytes = 1 << 20;
  set_heap(M_MMAP_THRESHOLD, kLargeBytes);
  set_heap(M_TRIM_THRESHOLD, kSpareBytes);
  set_heap(M_ARENA_MAX, 1);
}

// A separate function, so that its stack frame is released on return.
[[gnu::noinline]] void prefault_stack(std::size_t n_bytes) noexcept {
  constexpr std::size_t kLeastPage = 4096, kSpare = std::size_t{32} * 1024;
  const std::size_t left = stack_left();
  n_bytes = std::min(n_bytes, left > kSpare ? left - kSpare : 0);
  if (n_bytes == 0) return;
  auto* room = static_cast<volatile char*>(alloca(n_bytes));
  for (std::size_t at = 0; at < n_bytes; at += kLeastPage) room[at] = 0;
}

}  // namespace rt
