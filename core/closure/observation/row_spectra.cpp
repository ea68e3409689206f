#include "core/closure/observation/row_spectra.h"

#include <algorithm>
#include <complex>
#include <vector>

#include "core/spectrum/real_fft.h"

namespace core::closure {

Eigen::MatrixXcd row_spectra(const Eigen::MatrixXd& rows, int n_fft, double scale) {
  RealFft fft(n_fft);
  std::vector<double> series(static_cast<std::size_t>(n_fft), 0.0);
  std::vector<std::complex<double>> bins(static_cast<std::size_t>(fft.n_bins()));
  Eigen::MatrixXcd out(rows.rows(), fft.n_bins());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    for (Eigen::Index k = 0; k < rows.cols(); ++k) series[static_cast<std::size_t>(k)] = rows(i, k);
    fft.forward(series, bins);
    for (Eigen::Index b = 0; b < out.cols(); ++b) out(i, b) = scale * bins[static_cast<std::size_t>(b)];
  }
  return out;
}

int row_fft_size(const Eigen::MatrixXd& rows) { return std::max(4, next_power_of_two(static_cast<int>(rows.cols()))); }

}  // namespace core::closure
