// The allocator of a program in which calls fail (fault_calls.cpp).
#include <dlfcn.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>

#include "tests/faults/fault_kinds.h"
#include "tests/hooks/libc_allocator.h"

namespace faults {
namespace {

// Places that have allocated: open addressing, without a lock. A place that two threads add at once may count twice.
constexpr std::size_t kPlaces = 1U << 15U, kLarge = 32U << 10U;
std::array<std::atomic<std::uintptr_t>, kPlaces> places;  // relaxed: nothing else is handed over with an address

bool is_new_place(std::uintptr_t place) {
  for (std::size_t i = (place * 0x9E3779B97F4A7C15U) >> 49U, n = 0; n < kPlaces; i = (i + 1) % kPlaces, ++n) {
    std::uintptr_t there = places[i].load(std::memory_order_relaxed);
    if (there == place) return false;
    if (there == 0 && places[i].compare_exchange_strong(there, place, std::memory_order_relaxed)) return true;
    if (there == place) return false;
  }
  return false;
}

bool memory_fails(std::size_t n_bytes, void* place) {
  if (!is_counting.load(std::memory_order_relaxed) || (kind->calls & kMemory) == 0) return false;
  if (!is_new_place(reinterpret_cast<std::uintptr_t>(place)) && n_bytes < kLarge) return false;
  if (!is_hit(next_number())) return false;
  if (count->n_failed++ == 0) {
    Dl_info info{};
    count->call = -1;
    if (dladdr(place, &info) != 0 && info.dli_fname != nullptr) {
      std::strncpy(count->what.data(), info.dli_sname != nullptr ? info.dli_sname : info.dli_fname,
                   count->what.size() - 1);
    }
    count->place = reinterpret_cast<std::uintptr_t>(place) - reinterpret_cast<std::uintptr_t>(info.dli_fbase);
  }
  errno = ENOMEM;
  return true;
}

void* allocated(std::size_t n_bytes, std::size_t alignment, void* place) {
  for (;;) {  // as operator new of the standard library
    if (!memory_fails(n_bytes, place)) {
      if (void* memory = alignment <= 16 ? __libc_malloc(n_bytes) : __libc_memalign(alignment, n_bytes)) return memory;
    }
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr || (kind != nullptr && kind->name == "enomem_thrown")) throw std::bad_alloc();
    handler();
  }
}

}  // namespace
}  // namespace faults

using faults::allocated;
using faults::memory_fails;

extern "C" {
void* malloc(std::size_t n) { return memory_fails(n, __builtin_return_address(0)) ? nullptr : __libc_malloc(n); }
void* calloc(std::size_t m, std::size_t n) {
  return memory_fails(m * n, __builtin_return_address(0)) ? nullptr : __libc_calloc(m, n);
}
void* realloc(void* old, std::size_t n) {
  return n > 0 && memory_fails(n, __builtin_return_address(0)) ? nullptr : __libc_realloc(old, n);
}
void* memalign(std::size_t alignment, std::size_t n) {
  return memory_fails(n, __builtin_return_address(0)) ? nullptr : __libc_memalign(alignment, n);
}
void* aligned_alloc(std::size_t alignment, std::size_t n) {
  return memory_fails(n, __builtin_return_address(0)) ? nullptr : __libc_memalign(alignment, n);
}
int posix_memalign(void** out, std::size_t alignment, std::size_t n) {
  if (memory_fails(n, __builtin_return_address(0))) return ENOMEM;
  *out = __libc_memalign(alignment, n);
  return *out == nullptr ? ENOMEM : 0;
}
void free(void* memory) { __libc_free(memory); }
}

void* operator new(std::size_t n) { return allocated(n, 0, __builtin_return_address(0)); }
void* operator new[](std::size_t n) { return allocated(n, 0, __builtin_return_address(0)); }
void* operator new(std::size_t n, std::align_val_t alignment) {
  return allocated(n, static_cast<std::size_t>(alignment), __builtin_return_address(0));
}
void* operator new[](std::size_t n, std::align_val_t alignment) {
  return allocated(n, static_cast<std::size_t>(alignment), __builtin_return_address(0));
}
void* operator new(std::size_t n, const std::nothrow_t&) noexcept {
  return memory_fails(n, __builtin_return_address(0)) ? nullptr : __libc_malloc(n);
}
void operator delete(void* memory) noexcept { __libc_free(memory); }
void operator delete[](void* memory) noexcept { __libc_free(memory); }
void operator delete(void* memory, std::size_t) noexcept { __libc_free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { __libc_free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { __libc_free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { __libc_free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { __libc_free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { __libc_free(memory); }
