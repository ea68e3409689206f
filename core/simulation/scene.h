#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/simulation/injected/parameters.h"
#include "core/simulation/structure/structure_model.h"
#include "core/types/frame.h"

namespace core::simulation {

// World: X right, Y down, Z away from the camera, mm; the camera hovers about its mean position (the origin, unless
// given) and looks along +Z. Plates and background are planes of constant Z. Pixel centres lie at integers.

// Distortion of rays by the lens: x, y = X/Z, Y/Z -> distorted x, y.
struct LensParameters {
  enum class Model : std::uint8_t { kNone, kRadialTangential, kEquidistant };
  Model model = Model::kNone;
  std::array<double, 5> k{};  // radial-tangential: k1 k2 p1 p2 k3 (Brown 1971); equidistant: k1 .. k4 (Kannala 2006)
};

struct CameraParameters {
  int width_px = 1920, height_px = 1080;
  double alpha_px = 2100.0;  // focal length; square pixels
  double cx_px = 959.5, cy_px = 539.5;
  LensParameters lens;
  double rate_hz = 25.0;
  double readout_s = 0.026;  // first to last line in readout direction
  core::ReadoutDirection readout_direction = core::ReadoutDirection::kDown;
  double exposure_s = 0.004;
  double noise_sigma = 2.0;                               // grey levels, white, before rounding to 8 bits
  double x_mm = 0.0, y_mm = 0.0, z_mm = 0.0;              // mean position
  double pitch_rad = 0.0, yaw_rad = 0.0, roll_rad = 0.0;  // mean attitude: about X, then Y, then Z
};

// Excitation of the structure: white noise in a band (one Gaussian per frequency), lines, or both.
struct ExcitationParameters {
  // Weights: the ground's motion alone moves the last body by base * rms_mm, relative to the ground and over the clip,
  // the independent forces on every body alone by forces * rms_mm. 0 = none.
  double base = 1.0, forces = 0.0;
  double band_low_hz = 0.5, band_high_hz = 20.0;
  double rms_mm = 4.0;

  // Colour of the ground's motion, in addition to `base`: its amplitude times 1 + gain at the frequency (a resonance
  // curve).
  struct Peak {
    double frequency_hz = 0.0, damping_ratio = 0.05, gain = 0.0;
  };
  std::vector<Peak> base_peaks;
  struct Harmonic {  // a machine: a steady sinusoidal force on one body
    int body = 1;
    double frequency_hz = 0.0;
    double rms_mm = 0.0;  // of that body's response
  };
  std::vector<Harmonic> harmonics;
};

// A structure whose stiffness changes (changing_stiffness.h).
struct ChangeParameters {
  double frequency_drift = 0.0;  // of all frequencies over the clip, relative, about their mean
  double softening = 0.0;        // share of stiffness lost at an amplitude of sqrt(2) times the last body's rms
};

// Texture: cubic B-spline with independent Gaussian coefficients on a grid of this pitch, and what it shows beside them
// (render/texture_pattern.h).
struct TextureParameters {
  enum class Shows : std::uint8_t { kNoise, kFacade, kLandscape };
  double pitch_mm = 2.62;                    // content up to about 0.55 / pitch
  double mean = 128.0, contrast_rms = 25.0;  // grey levels
  Shows shows = Shows::kNoise;
};

// Visible face of one body: flat, parallel to the plane Z = 0. Centre: equilibrium position in the world.
struct Plate {
  std::string name;
  double x_mm = 0.0, y_mm = 0.0, z_mm = 2000.0;
  double width_mm = 300.0, height_mm = 50.0;
  TextureParameters texture;
};

struct BackgroundParameters {
  double depth_mm = 4000.0;
  TextureParameters texture{13.3, 120.0, 15.0};
};

// Drift of the camera: Gaussian, one-sided density ~ 1 / (1 + (f / corner)^order) up to limit_hz. With 0.318 Hz and
// order 6, 98 % of the variance lies below 0.5 Hz.
struct HoverParameters {
  double x_rms_mm = 25.0, y_rms_mm = 8.0, z_rms_mm = 25.0;
  double pitch_rms_rad = 0.0, yaw_rms_rad = 0.0, roll_rms_rad = 0.0;  // about X, Y, Z
  double zoom_rms = 0.0;                                              // breathing of the focal length, relative
  double corner_hz = 0.318, order = 6.0, limit_hz = 5.0;
};

// A recorded flight in camera axes (X right, Y down, Z forward), about its mean. Equal lengths.
struct RecordedMotion {
  double rate_hz = 0.0;
  std::vector<double> x_mm, y_mm, z_mm, pitch_rad, yaw_rad, roll_rad;
};

// Vibration of the camera at the rotors' rate, which wanders.
struct RotorParameters {
  double frequency_hz = 95.0;
  double wander_rms_hz = 0.3, wander_corner_hz = 0.1;
  double pitch_rms_rad = 0.0, yaw_rms_rad = 0.0, roll_rms_rad = 0.0;
};

// Jitter: independent, Gaussian, cut at 0.45 of a frame. Drops and duplicates: independent per frame.
struct TimingParameters {
  double jitter_rms_s = 0.0;
  double drop_probability = 0.0;
  double duplicate_probability = 0.0;  // repeats the previous picture with a stamp of its own
  bool stamps_tell = true;             // false: stamps are frame / rate, and missing frames are not indicated
};

struct LightParameters {
  double gain_rms = 0.0;        // of exposure or clouds, relative
  double gain_corner_hz = 0.2;  // density as the hover's, order 6
  double flicker_depth = 0.0;   // of lamps: light times 1 + depth cos(2 pi f t + phase)
  double flicker_hz = 100.0;
  double flicker_wander_hz = 0.0;  // rms of its change, in tens of seconds
};

// Errors that a tracker adds to the true tracks.
struct TrackParameters {
  int points_per_region = 30;
  double noise_px = 0.03;           // Gaussian, per axis, independent between points and frames
  double noise_spread = 0.0;        // noise differs between points: sd of its logarithm, rms over many points as above
  double sigma_error = 0.0;         // of the sigma stated per point: sd of the logarithm of stated / true
  double loss_probability = 0.0;    // of a point in a frame
  double pixel_locking_px = 0.0;    // amplitude of an error periodic in the sub-pixel phase
  double template_zoom_px = 0.0;    // error per unit of magnification since the first frame, in a direction that turns
  double brightness_bias_px = 0.0;  // error per unit of relative brightness change, in each point's own direction
};

// Errors of camera and tracker that remain if only channels are generated.
struct ChannelParameters {
  double noise_mm = 0.01;  // Gaussian, independent
  double loss_probability = 0.0;
};

// Everything that is rendered, tracked or sampled is a function of this struct alone.
struct Scene {
  std::uint64_t seed = 1;
  double duration_s = 60.0;
  CameraParameters camera;
  StructureModel structure;
  ExcitationParameters excitation;
  ChangeParameters change;
  std::vector<Plate> plates;  // by body: plates[0] stands on the ground
  BackgroundParameters background;
  HoverParameters hover;
  TailedHoverParameters tailed_hover;
  VibrationParameters vibration;
  FlapParameters flap;
  RockingParameters rocking;
  TorsionParameters torsion;
  SwayParameters sway;
  ShimmerParameters shimmer;
  StabiliserParameters stabiliser;
  BreathingParameters breathing;
  std::shared_ptr<const RecordedMotion> flight;  // in addition to the hover model; null = none
  RotorParameters rotor;
  TimingParameters timing;
  LightParameters light;
  TrackParameters tracks;
  ChannelParameters channels;

  [[nodiscard]] std::uint64_t n_frames() const noexcept;  // of the sensor, before drops
  [[nodiscard]] int n_bodies() const noexcept { return static_cast<int>(plates.size()); }
  [[nodiscard]] core::CameraInfo camera_info() const;
};

// Throws std::invalid_argument: NaN or values out of range, a structure that is unstable or does not fit the plates, a
// camera in or behind the structure, or a view that plates leave within 3 sigma of the drift.
void validate(const Scene& scene);

}  // namespace core::simulation
