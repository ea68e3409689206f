#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <vector>

#include "core/closure/observation/fit_view.h"
#include "core/closure/observation/free_motions.h"

namespace core::closure {

// A band of a spectrum, and the mean power of noise in its bins.
struct NoisyBand {
  Eigen::Index first = 0, last = 0;  // bins
  double noise = 0.0;
};

// What the residual does in step with one of the background's free motions.
struct InStep {
  double turn = 0.0;  // of the motion, as a turn of the camera leaves it in the residual; 1: all of it
  double turn_sigma = std::numeric_limits<double>::infinity();
  double pattern = 0.0;  // rms of any pattern over the points, beyond noise, relative to that of the motion itself

  // Nothing: what moves the background alone, or the whole image, leaves no residual.
  [[nodiscard]] bool is_nothing() const noexcept {
    return std::abs(turn) < kMostTurn && turn_sigma < kMostTurn && pattern < kMostPattern;
  }

 private:
  static constexpr double kMostTurn = 0.25, kMostPattern = 0.1;
};

// motion: 0, 1: translation of the background along u, v in px; 2: its zoom, relative. spectrum: of what it does, in
// the bins of `spectra`. The residual is regressed on it, which finds what is far too small to be seen in one frame. A
// turn of the camera (roll, pitch, yaw) leaves a known field, in a known ratio to the motion; an error of the points
// that the motion holds by its mean leaves a pattern that is as large.
[[nodiscard]] InStep in_step(const FitView& fit, Eigen::Index motion, const Eigen::VectorXcd& spectrum,
                             const TaperedSpectra& spectra, const std::vector<NoisyBand>& bands);

}  // namespace core::closure
