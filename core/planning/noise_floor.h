#pragma once

namespace core::planning {

// Factors that determine the accuracy of one tracked point.
//   sigma_px = tracker_factor sqrt(noise^2 + 1/12) / (gradient window)
// is the Cramer-Rao bound of a square patch per axis: the Fisher information of its window^2 pixels is sum (dI/du)^2 /
// noise^2; 1/12 is the variance of rounding to whole grey levels. There is no factor sqrt(2) for a second noisy image:
// all frames are compared with one fixed keyframe, whose noise shifts all of them alike. The tracker does not reach the
// bound: OpenCV's was measured at 2.0 times the bound for a noise of 2 grey levels.
struct PointQuality {
  double noise_grey = 2.0;     // rms of a pixel, 8-bit grey levels
  double gradient_grey = 8.0;  // rms over the patch, grey levels per px, along the motion
  double window_px = 21.0;
  double tracker_factor = 2.0;
};
[[nodiscard]] double point_sigma_px(const PointQuality& quality);  // throws std::invalid_argument

// Number of points with independent errors: overlapping patches share pixels, so a region has no more of them than its
// area, enlarged by half a patch on each side, over the area of a patch. A side of 0 px: unknown, all points count.
[[nodiscard]] double independent_points(int n_points, double width_px, double height_px, double window_px) noexcept;

struct NoiseFloor {
  double point_sigma_px = 0.0;
  double independent_points = 0.0;
  double channel_sigma_mm = 0.0;        // rms of one sample: S sigma_px / sqrt(points)
  double density_mm_per_sqrt_hz = 0.0;  // one-sided, white: channel_sigma sqrt(2 / f_s)
};
[[nodiscard]] NoiseFloor noise_floor(double point_sigma_px, double independent_points, double mm_per_px,
                                     double rate_hz) noexcept;

// Attenuation of a vibration by an exposure of T: |sin(pi f T) / (pi f T)|.
[[nodiscard]] double exposure_gain(double frequency_hz, double exposure_s) noexcept;

// A mode of rms `a` under broadband forces has the spectral density a^2 / (pi zeta f + B): pi zeta f is the width of a
// rectangle with the height and area of the resonance, B the noise bandwidth of the spectrum's window.
[[nodiscard]] double peak_density(double rms_mm, double damping_ratio, double frequency_hz,
                                  double bandwidth_hz) noexcept;
// The rms of a mode whose peak, attenuated by the exposure, is `ratio` (10 = 10 dB) times the density of the noise
// floor.
[[nodiscard]] double least_rms_mm(double ratio, double density_mm_per_sqrt_hz, double damping_ratio,
                                  double frequency_hz, double bandwidth_hz, double gain) noexcept;

}  // namespace core::planning
