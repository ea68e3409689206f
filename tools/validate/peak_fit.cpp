#include "tools/validate/peak_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

// Without a taper, leakage from the peak over 600 s exceeds the oscillator's own spectrum, which falls as f^-4,
// and the damping is overestimated. One Hann window costs 39 % of the accuracy: it wastes the ends of the record. K
// sine tapers cost sqrt(1 + 1 / (2 K)) and leak as little. They blur the peak by a kernel of variance mean(k^2) / (4
// T^2), which is included in the model: S + variance / 2 S''. K is chosen so that this changes the top of the peak by
// no more than 4 %; the next term is then a tenth of it, 0.03 of the damping's own scatter.

namespace tools {
namespace {

using Complex = std::complex<double>;

// Density of the displacement under white force, blurred.
double model(double f, double f0, double zeta, double variance_hz2) {
  const double apart = f0 * f0 - f * f, loss = 2.0 * zeta * f0;
  const double d = apart * apart + loss * loss * f * f;
  const double d1 = (-4.0 * apart + 2.0 * loss * loss) * f;
  const double d2 = -4.0 * f0 * f0 + 12.0 * f * f + 2.0 * loss * loss;
  return (1.0 + 0.5 * variance_hz2 * (2.0 * d1 * d1 / d - d2) / d) / d;
}

struct Band {
  std::size_t first, end;
};

Band band_of(const TaperedSpectrum& spectrum, double low_hz, double high_hz) {
  const auto end = static_cast<std::size_t>(high_hz / spectrum.bin_hz) + 1;
  return {static_cast<std::size_t>(std::ceil(low_hz / spectrum.bin_hz)), std::min(end, spectrum.density.size())};
}

// The damping from the area under the peak: variance = pi zeta f0 S(f0).
PeakFit first_guess(const TaperedSpectrum& spectrum, Band band) {
  std::size_t top = band.first;
  double area = 0.0;
  for (std::size_t k = band.first; k < band.end; ++k) {
    if (spectrum.density[k] > spectrum.density[top]) top = k;
    area += spectrum.density[k] * spectrum.bin_hz;
  }
  const double f = static_cast<double>(top) * spectrum.bin_hz;
  return {f, std::clamp(area / (std::numbers::pi * f * spectrum.density[top]), 1e-3, 0.1), false};
}

// One step of Fisher scoring in (ln level, ln f, ln zeta); the density is exponential (more narrowly, of Gamma law)
// about its model whatever the level, so all bins weigh alike. Returns the length of the step in units of zeta.
double step(const TaperedSpectrum& spectrum, Band band, double log_level, PeakFit& fit) {
  const double h = 1e-4 * fit.damping_ratio, v = spectrum.kernel_variance_hz2;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  const double f0 = fit.frequency_hz, zeta = fit.damping_ratio;
  for (std::size_t k = band.first; k < band.end; ++k) {
    const double f = static_cast<double>(k) * spectrum.bin_hz, here = model(f, f0, zeta, v);
    const double by_f = (model(f, f0 * (1.0 + h), zeta, v) - model(f, f0 * (1.0 - h), zeta, v)) / (2.0 * h * here);
    const double by_zeta = (model(f, f0, zeta * 1.001, v) - model(f, f0, zeta * 0.999, v)) / (0.002 * here);
    const Eigen::Vector3d gradient(1.0, by_f, by_zeta);
    normal += gradient * gradient.transpose();
    right += gradient * (spectrum.density[k] / (std::exp(log_level) * here) - 1.0);
  }
  const Eigen::Vector3d change = normal.ldlt().solve(right);
  const double f_step = std::clamp(change(1), -0.5 * zeta, 0.5 * zeta), zeta_step = std::clamp(change(2), -0.5, 0.5);
  fit.frequency_hz *= std::exp(f_step);
  fit.damping_ratio *= std::exp(zeta_step);
  return std::abs(f_step) / zeta + std::abs(zeta_step);
}

double best_log_level(const TaperedSpectrum& spectrum, Band band, const PeakFit& fit) {
  double sum = 0.0;
  for (std::size_t k = band.first; k < band.end; ++k) {
    const double f = static_cast<double>(k) * spectrum.bin_hz;
    sum += spectrum.density[k] / model(f, fit.frequency_hz, fit.damping_ratio, spectrum.kernel_variance_hz2);
  }
  return std::log(sum / static_cast<double>(band.end - band.first));
}

}  // namespace

// Taper k is sin(pi k (t + 1) / (n + 1)): the difference of two shifted transforms, all of which a transform of length
// 2 (n + 1) holds.
TaperedSpectrum::TaperedSpectrum(const std::vector<double>& samples, double rate_hz, int n_tapers) {
  const std::size_t n = samples.size() + 1, twice = 2 * n;
  std::vector<Complex> padded(twice), transform;
  std::copy(samples.begin(), samples.end(), padded.begin());
  Eigen::FFT<double> fft;
  fft.fwd(transform, padded);
  bin_hz = rate_hz / static_cast<double>(n);
  density.resize(n / 2);
  for (std::size_t k = 1; k <= static_cast<std::size_t>(n_tapers); ++k) {
    const Complex turn = std::polar(1.0, std::numbers::pi * static_cast<double>(k) / static_cast<double>(n));
    for (std::size_t i = 0; i < density.size(); ++i) {
      const Complex below = transform[(2 * i + twice - k) % twice], above = transform[(2 * i + k) % twice];
      density[i] += std::norm(turn * below - std::conj(turn) * above) / n_tapers;
    }
    kernel_variance_hz2 += static_cast<double>(k * k) * bin_hz * bin_hz / (4.0 * n_tapers);
  }
}

int taper_count(double half_width_hz, double duration_s) {
  constexpr double kMostBlur = 0.04;
  constexpr int kMostTapers = 30;
  const double most = kMostBlur * 4.0 * std::pow(half_width_hz * duration_s, 2);
  int k = 1;
  while (k < kMostTapers && (k + 2) * (2 * k + 3) / 6.0 <= most) ++k;  // mean of the first squares
  return k;
}

PeakFit fit_peak(const TaperedSpectrum& spectrum, double low_hz, double high_hz) {
  constexpr int kMostSteps = 60;
  PeakFit fit = first_guess(spectrum, band_of(spectrum, low_hz, high_hz));
  const Band band =
      band_of(spectrum, std::max(low_hz, 0.5 * fit.frequency_hz), std::min(high_hz, 1.6 * fit.frequency_hz));
  double log_level = best_log_level(spectrum, band, fit);
  for (int i = 0; i < kMostSteps && !fit.converged; ++i) {
    fit.converged = step(spectrum, band, log_level, fit) < 1e-6;
    log_level = best_log_level(spectrum, band, fit);
  }
  return fit;
}

}  // namespace tools
