#pragma once

namespace core {

// Inner products as kLanes partial sums, whatever the machine's vector width: bit-identical everywhere.
inline constexpr int kLanes = 8;

template <int kWidth>
struct Lanes {
  using Vector [[gnu::vector_size(kWidth * sizeof(double)), gnu::aligned(8), gnu::may_alias]] = double;
};

// The implementation for this machine's vectors of two, four or eight doubles.
template <class Function>
[[nodiscard]] Function by_vector_width(Function two, [[maybe_unused]] Function four, [[maybe_unused]] Function eight) {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx512f")) return eight;
  if (__builtin_cpu_supports("avx2")) return four;
#endif
  return two;
}

}  // namespace core
