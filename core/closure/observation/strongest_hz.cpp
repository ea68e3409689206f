#include "core/closure/observation/strongest_hz.h"

#include <complex>
#include <vector>

#include "core/spectrum/real_fft.h"

namespace core::closure {

double strongest_hz(const Eigen::RowVectorXd& amplitude, double rate_hz) {
  int n = 16;
  while (n < amplitude.size()) n *= 2;
  RealFft fft(n);
  std::vector<double> series(static_cast<std::size_t>(n), 0.0);
  const double mean = amplitude.mean();
  for (Eigen::Index k = 0; k < amplitude.size(); ++k) series[static_cast<std::size_t>(k)] = amplitude(k) - mean;
  std::vector<std::complex<double>> bins(static_cast<std::size_t>(fft.n_bins()));
  fft.forward(series, bins);
  // Summed over neighbours: one bin of a wide peak is chance.
  constexpr std::ptrdiff_t kHalf = 4;
  double most = -1.0;
  std::ptrdiff_t at = 0;
  for (std::ptrdiff_t b = kHalf; b + kHalf < std::ssize(bins); ++b) {
    double sum = 0.0;
    for (std::ptrdiff_t d = -kHalf; d <= kHalf; ++d) sum += std::norm(bins[static_cast<std::size_t>(b + d)]);
    if (sum > most) most = sum, at = b;
  }
  return rate_hz * static_cast<double>(at) / n;
}

}  // namespace core::closure
