#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "core/closure/observation/free_motions.h"

namespace core::closure {

// Shift of whole frames against the motion of a camera, above a corner frequency and with a lag: gain times form().
struct ShiftResponse {
  double gain = 0.0, corner_hz = 0.0, lag_s = 0.0;

  [[nodiscard]] std::complex<double> form(double hz) const;
};

struct FittedShift {
  ShiftResponse response;
  double gain_sigma = 0.0, corner_sigma = 0.0, lag_sigma = 0.0;
  double depths = 0.0;     // ratio r of the depth of the structure to that of the background
  double rise = 0.0;       // of the logarithm of the likelihood, from no shift to this one
  double free_rise = 0.0;  // to a response of any form
  Eigen::VectorXcd shift;  // of the frames, px, in all bins of the spectra; zero outside the bands
};

// Frames are shifted by G c, c: motion of the camera in the image of the structure. Structure and background are
// shifted alike, S = (1 - G) c and B = (r - G) c, so that B = r S - (1 - r) G / (1 - G) S. The background's spectrum in
// one direction is fitted by real multiples of its causes and of G / (1 - G) S, over the bins below 4 Hz. Each band is
// divided by what the first solutions left there.
class ShiftRegression {
 public:
  struct Band {
    Eigen::Index first = 0, last = 0;  // bins
  };

  // spectra: of the background, then of its causes, the base first.
  explicit ShiftRegression(const TaperedSpectra& spectra);

  [[nodiscard]] const std::vector<Band>& bands() const noexcept { return bands_; }
  // rise 0: there is none.
  [[nodiscard]] FittedShift fit() const;

 private:
  struct Solution {
    Eigen::VectorXd values;  // of the causes, then of the added columns
    Eigen::MatrixXd covariance;
    Eigen::VectorXcd left;
  };

  [[nodiscard]] Eigen::Index size() const noexcept { return static_cast<Eigen::Index>(bins_.size()); }
  [[nodiscard]] Solution solve(const Eigen::MatrixXcd& added) const;
  [[nodiscard]] Eigen::VectorXcd left_without() const { return solve(Eigen::MatrixXcd(size(), 0)).left; }
  // Beside one complex multiple of the base in each band.
  [[nodiscard]] Eigen::VectorXcd left_by_any() const;
  void weigh(const Eigen::VectorXcd& left);
  // The level of each band is unknown.
  [[nodiscard]] double rise_to(const Eigen::VectorXcd& left) const;
  // G / (1 - G) S per unit of the gain.
  [[nodiscard]] Eigen::VectorXcd shift(const ShiftResponse& response) const;
  [[nodiscard]] double gain_of(const Eigen::VectorXd& values, Eigen::Index column) const;
  [[nodiscard]] FittedShift best_of_grid(double gain) const;
  void refine(FittedShift& fitted) const;  // between the grid's points, by one step of Gauss and Newton

  const TaperedSpectra& spectra_;
  std::vector<Band> bands_;
  std::vector<Eigen::Index> bins_;
  Eigen::VectorXd weight_;
  Eigen::VectorXcd moved_, before_;  // the background; what its causes leave of it
  Eigen::MatrixXcd causes_;
};

}  // namespace core::closure
