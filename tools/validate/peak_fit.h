#pragma once

#include <vector>

namespace tools {

// Spectral density, up to a factor, at frequencies k / duration: the mean over the first `n_tapers` sine tapers (Riedel
// & Sidorenko, IEEE Trans. Signal Processing 43, 1995).
struct TaperedSpectrum {
  double bin_hz = 0.0;
  double kernel_variance_hz2 = 0.0;  // second moment of what the tapers convolve the density with
  std::vector<double> density;

  TaperedSpectrum(const std::vector<double>& samples, double rate_hz, int n_tapers);
};

// The number of tapers for which a peak of this half width (zeta f) is not noticeably blurred.
[[nodiscard]] int taper_count(double half_width_hz, double duration_s);

// The oscillator whose displacement under white force explains a band of the spectrum best.
struct PeakFit {
  double frequency_hz = 0.0, damping_ratio = 0.0;
  bool converged = false;
};

// Whittle's likelihood, maximised over frequency, damping and level by Fisher scoring, from the spectrum's own maximum:
// uses no declared value. The band runs from 0.5 to 1.6 times the frequency, cut at the limits.
[[nodiscard]] PeakFit fit_peak(const TaperedSpectrum& spectrum, double low_hz, double high_hz);

}  // namespace tools
