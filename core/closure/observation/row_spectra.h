#pragma once

#include <Eigen/Core>

namespace core::closure {

// Transform of each row, padded with zeros to n_fft samples (a power of two): rows x (n_fft / 2 + 1) bins, times scale.
[[nodiscard]] Eigen::MatrixXcd row_spectra(const Eigen::MatrixXd& rows, int n_fft, double scale = 1.0);
// The shortest such length that holds the rows.
[[nodiscard]] int row_fft_size(const Eigen::MatrixXd& rows);

}  // namespace core::closure
