#include "drivers/host/memory_reserve.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>

namespace drivers {
namespace {

constexpr std::size_t kReserveBytes = std::size_t{8} << 20U;

// acq_rel: whoever takes the reserve is the only one that frees it; the reader of memory_reserve_is_used() needs no
// more than the value.
std::atomic<void*> reserve{nullptr};
std::atomic<bool> is_used{false};

void take_reserve() {
  void* const memory = reserve.exchange(nullptr, std::memory_order_acq_rel);
  if (memory == nullptr) throw std::bad_alloc();
  is_used.store(true, std::memory_order_relaxed);
  std::free(memory);
}

}  // namespace

void keep_memory_reserve() {
  void* const memory = std::malloc(kReserveBytes);
  if (memory == nullptr) throw std::bad_alloc();
  std::memset(memory, 1, kReserveBytes);  // pages that were only promised are no reserve
  std::free(reserve.exchange(memory, std::memory_order_acq_rel));
  std::set_new_handler(&take_reserve);
}

bool memory_reserve_is_used() noexcept { return is_used.load(std::memory_order_relaxed); }

}  // namespace drivers
