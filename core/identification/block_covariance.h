#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identification/correlation.h"

namespace core {

// Successive samples of some channels, in frames: first, first + step, ... (n of them; step 1 or -1). A vector of them
// is ordered by sample, then by channel.
struct SampleWindow {
  std::vector<int> channels;
  int first = 0, n = 0, step = 1;

  [[nodiscard]] int size() const noexcept { return n * static_cast<int>(channels.size()); }
  [[nodiscard]] int time(int k) const noexcept { return first + step * k; }
};

enum class Estimate : std::uint8_t { kDivided, kUndivided };  // of the correlations (correlation.h)

// E[rows columns^T] of channels divided by `scale`. The correlations must reach the lags between the windows.
[[nodiscard]] Eigen::MatrixXd block_covariance(const Correlations& correlations, const Eigen::VectorXd& scale,
                                               const SampleWindow& rows, const SampleWindow& columns,
                                               Estimate estimate);

}  // namespace core
