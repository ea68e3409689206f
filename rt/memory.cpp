#include "rt/memory.h"

#include <alloca.h>
#include <malloc.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstring>

namespace rt {

std::string lock_memory() {
  if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return {};
  return std::string("locking memory refused (") + std::strerror(errno) +
         "): grant CAP_IPC_LOCK or raise RLIMIT_MEMLOCK";
}

void keep_freed_memory() noexcept {
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_MMAP_MAX, 0);
}

// A frame of its own, so that the room is given back on return.
[[gnu::noinline]] void prefault_stack(std::size_t n_bytes) noexcept {
  constexpr std::size_t kLeastPage = 4096;
  if (n_bytes == 0) return;
  auto* room = static_cast<volatile char*>(alloca(n_bytes));
  for (std::size_t at = 0; at < n_bytes; at += kLeastPage) room[at] = 0;
}

}  // namespace rt
