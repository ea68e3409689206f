#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>

// Counts operator new and delete of the calling thread while an AllocGuard lives. Defines the global operators: include
// in exactly one source of an executable.

namespace test_support {

struct AllocCounts {
  bool counting = false;
  std::size_t n_new = 0;
  std::size_t n_delete = 0;
};

inline AllocCounts& alloc_counts() noexcept {
  thread_local constinit AllocCounts counts;
  return counts;
}

class AllocGuard {
 public:
  AllocGuard() noexcept { alloc_counts() = {true, 0, 0}; }
  ~AllocGuard() { alloc_counts().counting = false; }
  AllocGuard(const AllocGuard&) = delete;
  AllocGuard& operator=(const AllocGuard&) = delete;

  [[nodiscard]] std::size_t n_new() const noexcept { return alloc_counts().n_new; }
  [[nodiscard]] std::size_t n_delete() const noexcept { return alloc_counts().n_delete; }
};

#ifdef __SANITIZE_ADDRESS__
inline constexpr bool kAllocationsCounted = false;
#else
inline constexpr bool kAllocationsCounted = true;
#endif

inline void* counted_allocate(std::size_t size, std::size_t alignment) {
  AllocCounts& counts = alloc_counts();
  if (counts.counting) ++counts.n_new;
  const std::size_t whole = (size + alignment - 1) / alignment * alignment;  // aligned_alloc asks for a multiple
  void* memory = std::aligned_alloc(alignment, whole == 0 ? alignment : whole);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

inline void counted_free(void* memory) noexcept {
  AllocCounts& counts = alloc_counts();
  if (counts.counting && memory != nullptr) ++counts.n_delete;
  std::free(memory);
}

}  // namespace test_support

#ifndef __SANITIZE_ADDRESS__
void* operator new(std::size_t size) { return test_support::counted_allocate(size, alignof(std::max_align_t)); }
void* operator new[](std::size_t size) { return test_support::counted_allocate(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return test_support::counted_allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return test_support::counted_allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { test_support::counted_free(memory); }
void operator delete[](void* memory) noexcept { test_support::counted_free(memory); }
void operator delete(void* memory, std::size_t) noexcept { test_support::counted_free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { test_support::counted_free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { test_support::counted_free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { test_support::counted_free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { test_support::counted_free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { test_support::counted_free(memory); }
#endif
