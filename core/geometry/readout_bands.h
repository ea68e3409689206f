#pragma once

#include <span>

#include "core/geometry/readout_estimator.h"

namespace core {

// Combines the sums per block and band to one readout time (formulas: readout_estimator.h). blocks: of equal length, in
// order; window_energy: sum of the window's squares. Memory on the stack only.
[[nodiscard]] ReadoutEstimate combine_bands(
    std::span<const std::array<ReadoutEstimator::Sums, ReadoutEstimator::kMaxBands>> blocks, std::size_t n_bands,
    double window_energy) noexcept;

}  // namespace core
