#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/simulation/scene.h"

namespace tools {

// Checks of the renderer, each on scenes of its own; textures, motion and noise are those of the seed.

// Error of a shift: measured less known, px.
struct ShiftError {
  std::string name;
  double worst_px = 0.0, rms_px = 0.0;  // over shifts, plates and both axes
  int n_shifts = 0;
  bool smooth = true;  // texture of at most 0.2 cycles/px; otherwise of 1.6 px pitch
};
// Plates at known sub-pixel shifts, rendered and measured again: Gauss-Newton with the texture itself as the model, on
// light without noise; its own error is below 1e-6 px. Smooth and sharp texture, at rest and blurred by motion, seen
// straight, with 5 degrees roll, through a lens, and in all four directions of readout.
[[nodiscard]] std::vector<ShiftError> check_known_shifts(std::uint64_t seed);

// Rendered light minus light by brute force (RenderReference), in grey levels.
struct ReferenceError {
  std::string name;
  double worst = 0.0, rms = 0.0;
  int n_pixels = 0;
};
// Insides of plates and background (64 instants), and edges of flat plates (256 points a pixel; grey levels of a step
// of 100).
[[nodiscard]] std::vector<ReferenceError> check_reference_pixels(std::uint64_t seed);

// Tracks of OpenCV's KLT in rendered frames minus the true tracks, px, per axis.
struct TrackError {
  std::string name;
  double worst_px = 0.0, rms_px = 0.0;
  double truth_rms_px = 0.0;     // rms motion of the points
  int n_tracks = 0, n_lost = 0;  // points times frames
};
// 1080p, noise of 2 grey levels, `n_frames` spread over a minute: the paper's scene; with 3 degrees roll, rotation and
// a lens; read to the left.
[[nodiscard]] std::vector<TrackError> check_opencv_tracks(std::uint64_t seed, int n_frames = 40);

// Mean grey level of each row under flickering lamps divided by that without, minus Light::factor: largest, relative.
[[nodiscard]] double check_flicker_bands(std::uint64_t seed);

struct RenderSpeed {
  std::string name;
  double frames_per_s = 0.0;
};
// 1080p, 8 bits, on n_threads threads at once: the fast path and the general one.
[[nodiscard]] std::vector<RenderSpeed> check_render_speed(std::uint64_t seed, int n_threads = 2);

// Tables of check_opencv_tracks() and check_render_speed() on standard output.
void print_klt_errors(std::uint64_t seed, int n_frames);
void print_render_speed(std::uint64_t seed, int n_threads);

}  // namespace tools
