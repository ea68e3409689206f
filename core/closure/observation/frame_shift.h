#pragma once

#include <Eigen/Core>

namespace core::closure {

// Series over frames at other instants than their own: band-limited interpolation and differentiation by a discrete
// Fourier transform. Shifts keep the amplitude of every frequency below half the rate and the variance of white noise.
// Beyond its ends a series is continued by reflection in the end points and blended into a period, so that results
// within a few frames of the ends are less accurate. Rows are series. The same bits on every run.
class FrameShift {
 public:
  explicit FrameShift(Eigen::Index n_frames);

  // Row i becomes its value `frames(i)` later: out(i, k) = series(i)(k + frames(i)).
  void advance(Eigen::MatrixXd& series, const Eigen::VectorXd& frames) const;

  // Derivative per frame of the signal in series of signal plus white noise of this variance: Wiener's filter, with the
  // signal's spectrum learned from the series itself.
  [[nodiscard]] Eigen::MatrixXd signal_rates(const Eigen::MatrixXd& series, double noise_variance) const;

  // Bins 0 .. n_fft() / 2 of each row; white noise of unit variance has the mean square n_fft() in a bin. And back.
  [[nodiscard]] Eigen::MatrixXcd spectra(const Eigen::MatrixXd& series) const;
  [[nodiscard]] Eigen::MatrixXd series(const Eigen::MatrixXcd& spectra) const;
  [[nodiscard]] int n_fft() const noexcept { return n_fft_; }

 private:
  Eigen::Index n_frames_;
  int n_fft_;
};

}  // namespace core::closure
