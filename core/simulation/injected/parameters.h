#pragma once

#include <array>

namespace core::simulation {

// Effects of real records, made by other means than those by which core/closure explains them (METHOD.md has the table).
// The default of each is none.

// Hover whose spectrum falls off as a power law instead of ending: per axis a Gaussian process of its own, with a
// one-sided density ~ 1 / (1 + (f / corner)^order) up to 100 Hz, which no camera resolves. Beside HoverParameters, which
// it may replace.
struct TailedHoverParameters {
  std::array<double, 3> rms_mm{}, corner_hz{0.2, 0.2, 0.2}, order{4.0, 4.0, 4.0};                   // X, Y, Z
  std::array<double, 3> rms_rad{}, turn_corner_hz{0.2, 0.2, 0.2}, turn_order{4.0, 4.0, 4.0};  // pitch, yaw, roll
};

// The gimbal shakes in a band about one frequency: pitch, yaw, roll and X, Y, Z together, each half of it common to all.
struct VibrationParameters {
  double centre_hz = 6.0, width_hz = 1.0;  // one-sided density ~ exp(-((f - centre) / width)^2 / 2)
  std::array<double, 3> rms_rad{}, rms_mm{};
};

// A lightly damped oscillator under white noise of its own.
struct OscillatorParameters {
  double frequency_hz = 3.0, damping_ratio = 0.02;
};
struct FlapParameters : OscillatorParameters {  // a part of a plate moves along the structure's axis by itself
  int body = 1;                                 // from this share of the plate's width on, to the right of its left edge
  double from_share = 0.5, rms_mm = 0.0;
};
struct RockingParameters : OscillatorParameters {  // the whole structure turns about the middle of its base's plate
  double rms_rad = 0.0;
};
struct TorsionParameters : OscillatorParameters {  // bodies turn about their upright axis, in proportion to their number
  double rms_rad = 0.0;                            // of the last one
};
struct SwayParameters : OscillatorParameters {  // the background moves to the side
  double rms_mm = 0.0;
};

// Refraction by moving air: the image is shifted by the gradient of a Gaussian phase screen (von Karman between an outer
// and an inner scale) that drifts over the image and boils.
struct ShimmerParameters {
  double rms_px = 0.0;                       // of the shift, per axis
  double outer_px = 400.0, inner_px = 60.0;  // in the image
  std::array<double, 2> drift_px_s{60.0, 0.0};
  double boiling_px_s = 20.0;  // spread of the drift over the screen's waves
};

// Electronic stabilisation: every frame is moved and turned as a whole against the camera's motion above the corner, as
// it was `lag` ago.
struct StabiliserParameters {
  double gain = 0.0;  // 1 = all of it
  double corner_hz = 0.5, lag_s = 0.03;
};

// The lens hunts for focus: the image grows and shrinks about a centre that is not the principal point.
struct BreathingParameters {
  double rms = 0.0;  // relative
  double corner_hz = 0.3;
  std::array<double, 2> centre_px{};  // from the principal point
};

}  // namespace core::simulation
