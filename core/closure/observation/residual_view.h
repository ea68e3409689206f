#pragma once

#include <Eigen/Core>
#include <vector>

namespace core::closure {

// Summary of a residual of tracks, for plots.
struct ResidualView {
  Eigen::MatrixXd place_px;                    // points x 2 (u, v), mean position
  Eigen::MatrixXd pattern_px;                  // points x 2: its leading pattern, as rms over time
  std::vector<double> singular_px;             // rms over time and values of each pattern, in descending order
  std::vector<double> frequency_hz, level_px;  // rms per root Hz over all values
};

// residual_px: 2 points x frames (rows u, v of point 0, ...). Hann windows of 20 s or less, half overlapping.
[[nodiscard]] ResidualView residual_view(const Eigen::MatrixXd& residual_px, const Eigen::VectorXd& mean_px,
                                         double rate_hz);

}  // namespace core::closure
