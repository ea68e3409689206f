#pragma once

#include <cstdint>
#include <vector>

#include "core/types/frame.h"

namespace core::simulation {

// World: X right, Y down, Z away from the camera, mm; the camera hovers about the origin and looks along +Z. The
// structure's plates and the background are planes of constant Z. Pixel centres lie at integers.

struct CameraParameters {
  int width_px = 1920, height_px = 1080;
  double alpha_px = 2100.0;  // focal length; square pixels, no distortion
  double cx_px = 959.5, cy_px = 539.5;
  double rate_hz = 25.0;
  double readout_s = 0.026;  // row v starts its exposure at frame / rate + readout v / height
  double exposure_s = 0.004;
  double noise_sigma = 2.0;  // grey levels, white, before rounding to 8 bits
};

// Shear building on a shaking table that moves along X. Masses are uniform, shapes those of the uniform fixed-free
// shear chain, phi_r(i) = sin((2 r - 1) i pi / (2 n + 1)); frequencies are given, one per storey.
struct StructureParameters {
  std::vector<double> frequency_hz;
  std::vector<double> damping_ratio;
  double band_low_hz = 0.5, band_high_hz = 20.0;  // of the white base acceleration
  double roof_rms_mm = 4.0;                       // relative to the base, over the clip; scales the input. 0 = at rest

  [[nodiscard]] int n_floors() const noexcept { return static_cast<int>(frequency_hz.size()); }
};

// Texture: cubic B-spline with independent Gaussian coefficients on a grid of this pitch.
struct TextureParameters {
  double pitch_mm = 2.62;                    // content up to about 0.55 / pitch
  double mean = 128.0, contrast_rms = 25.0;  // grey levels
};

// Body 0 is the base plate on the table, body i the plate of floor i; each is a width x height face in one plane.
struct PlateParameters {
  double width_mm = 300.0, height_mm = 50.0;
  double storey_mm = 140.0;  // centre to centre
  double depth_mm = 2000.0;  // stand-off
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
  double corner_hz = 0.318, order = 6.0, limit_hz = 5.0;

  [[nodiscard]] bool rotates() const noexcept { return pitch_rms_rad > 0.0 || yaw_rms_rad > 0.0 || roll_rms_rad > 0.0; }
};

// Everything that is rendered or tracked is a function of this struct alone.
struct Scene {
  std::uint64_t seed = 1;
  double duration_s = 60.0;
  CameraParameters camera;
  StructureParameters structure;
  PlateParameters plates;
  BackgroundParameters background;
  HoverParameters hover;

  [[nodiscard]] std::uint64_t n_frames() const noexcept;
  [[nodiscard]] int n_bodies() const noexcept { return structure.n_floors() + 1; }
  [[nodiscard]] double body_y_mm(int body) const noexcept;  // centre of the body's plate at rest
  [[nodiscard]] core::CameraInfo camera_info() const;
};

// The experiment of the paper: six storeys at 1.657 ... 14.34 Hz, 1 % damping, a 1080p camera at 25 fps 2 m away.
[[nodiscard]] Scene make_paper_scene(std::uint64_t seed, double duration_s);

// The same view with another sensor: alpha and textures scale with the image so that the scene fits it alike.
void set_image_size(Scene& scene, int width_px, int height_px);

// Throws std::invalid_argument: NaN or out-of-range values, and a view that plates leave within 3 sigma of the drift.
void validate(const Scene& scene);

}  // namespace core::simulation
