#pragma once

#include <algorithm>
#include <complex>
#include <functional>
#include <vector>

#include "core/types/cpsd.h"

namespace core {

// `into` becomes the block of both. Same sizes; nothing allocates.
inline void join_blocks(CpsdBlock& into, const CpsdBlock& from) noexcept {
  const auto add = [](std::vector<std::complex<double>>& sum, const std::vector<std::complex<double>>& more) {
    std::transform(sum.begin(), sum.end(), more.begin(), sum.begin(), std::plus<>());
  };
  into.n_segments += from.n_segments;
  into.weight.join(from.weight);
  add(into.data_sum, from.data_sum);
  add(into.mask_sum, from.mask_sum);
}

}  // namespace core
