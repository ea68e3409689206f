#pragma once

#include <Eigen/Core>

namespace core::closure {

// Resamples series over frames at other instants: band-limited interpolation and differentiation by a discrete Fourier
// transform. Shifts keep the amplitude of every frequency below half the rate and the variance of white noise. Beyond
// its ends a series is continued by reflection in the end points and blended into a period, so that results within a
// few frames of the ends are less accurate. Rows are series. Results are bit-identical in every run.
class FrameShift {
 public:
  explicit FrameShift(Eigen::Index n_frames);

  // Replaces row i by its value `frames(i)` later: out(i, k) = series(i)(k + frames(i)).
  void advance(Eigen::MatrixXd& series, const Eigen::VectorXd& frames) const;

  // Derivative per frame of the signal in a series of signal plus white noise of this variance: Wiener filter, with the
  // signal's spectrum estimated from the series itself.
  [[nodiscard]] Eigen::MatrixXd signal_rates(const Eigen::MatrixXd& series, double noise_variance) const;

  // Bins 0 .. n_fft() / 2 of each row, and the inverse. White noise of unit variance has mean square n_fft() in a bin.
  [[nodiscard]] Eigen::MatrixXcd spectra(const Eigen::MatrixXd& series) const;
  [[nodiscard]] Eigen::MatrixXd series(const Eigen::MatrixXcd& spectra) const;
  [[nodiscard]] int n_fft() const noexcept { return n_fft_; }

 private:
  Eigen::Index n_frames_;
  int n_fft_;
};

}  // namespace core::closure
