#pragma once

#include <algorithm>
#include <complex>
#include <functional>
#include <vector>

#include "core/types/cpsd.h"

namespace core {

// Both must have the same size; does not allocate.
inline void add_sums(std::vector<std::complex<double>>& into, const std::vector<std::complex<double>>& from) noexcept {
  std::transform(into.begin(), into.end(), from.begin(), into.begin(), std::plus<>());
}

// Adds `from` to `into`. Both must have the same sizes; does not allocate.
inline void join_blocks(CpsdBlock& into, const CpsdBlock& from) noexcept {
  into.n_segments += from.n_segments;
  into.weight.join(from.weight);
  add_sums(into.data_sum, from.data_sum);
  add_sums(into.mask_sum, from.mask_sum);
}

}  // namespace core
