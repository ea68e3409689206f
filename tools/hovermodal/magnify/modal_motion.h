#pragma once

#include <complex>
#include <optional>
#include <string>
#include <vector>

namespace tools {

// One region in the motion of one mode.
struct RegionMotion {
  std::string name;
  double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;  // around its points in the first frame, px
  // In the image (u right, v down), of the mode's shape, whose largest component is 1; and their standard deviations.
  std::complex<double> shape_u, shape_v;
  double sigma_u = 0.0, sigma_v = 0.0;
  bool is_static = false;  // a region without a channel: background, ground
  // Why it is held still although it has a channel; empty: it is not.
  std::string held;
};

// How one mode moved the structure in a run.
struct ModalMotion {
  double frequency_hz = 0.0, apparent_hz = 0.0;
  std::optional<double> frequency_std_hz;
  int width_px = 0, height_px = 0;  // of the run's image
  double rate_hz = 0.0;             // of its frames
  // Of the component 1, in the first frame's pixels: root 2 times the rms of the record's part within 4 zeta f of the
  // mode's frequency.
  double amplitude_px = 0.0;
  std::vector<RegionMotion> regions;
};

// A component below this many standard deviations is not distinguished from noise.
inline constexpr double kLeastSigmas = 2.0;

// `folder`: of a run, with modal.json, displacements.csv and tracks.csv. `number`: of the mode, from 1.
// Throws drivers::FileError, std::invalid_argument for a mode that there is not; std::runtime_error where the shape has
// no standard deviation or is not above it: this would magnify noise.
[[nodiscard]] ModalMotion modal_motion(const std::string& folder, int number);

}  // namespace tools
