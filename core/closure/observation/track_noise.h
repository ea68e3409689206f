#pragma once

#include <Eigen/Core>

namespace core::closure {

// Errors of tracked points in time. A sensor's are independent from frame to frame; those of a video codec persist
// until the next frame that is coded for itself (the first of a group of pictures).
struct TrackNoise {
  double correlation_s = 0.0;  // time in which their autocorrelation falls to 1/e; 0: independent from frame to frame
  // Every so many frames they change more than otherwise, by this factor (rms). 0 frames: no such period is
  // significant.
  int group_frames = 0;
  double group_change = 1.0;
};

// residual: 2 points x frames, in sigmas, on an even grid; a frame of zeros is a gap. Periods from 2 frames to an
// eighth of the record and at most 300 frames are tested; one is significant if the changes at its strongest phase
// exceed the others by 6 standard deviations of their mean logarithm (45 000 phases of all periods: chance 5e-5).
[[nodiscard]] TrackNoise track_noise(const Eigen::MatrixXd& residual, double rate_hz);

}  // namespace core::closure
