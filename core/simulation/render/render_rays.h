#pragma once

#include <vector>

#include "core/simulation/scene.h"

namespace core::simulation {

// The ideal (undistorted) ray X / Z, Y / Z of every pixel, one line at a time. With a lens: by cubic interpolation
// between exact rays every 8 px, with an error below 1e-4 px wherever the lens does not fold. Valid at any zoom,
// because a zoomed pixel has the ray of another place on the unzoomed sensor.
class RayMap {
 public:
  RayMap(const CameraParameters& camera, double zoom_rms);

  // x, y: width (height) values. Finite, whatever the lens.
  void row(int v, double zoom, double* x, double* y) const noexcept;
  void column(int u, double zoom, double* x, double* y) const noexcept;
  [[nodiscard]] bool bent() const noexcept { return bent_; }

 private:
  struct Axis {
    int n_pixels, n_knots, stride;  // stride: from knot to knot
    double centre_px, first_px;     // of the principal point; of knot 0
  };
  void line(const Axis& along, const Axis& across, double across_px, double zoom, double* x, double* y) const noexcept;

  double alpha_px_;
  bool bent_;
  Axis u_, v_;
  std::vector<double> knot_x_, knot_y_;  // rows of u_.n_knots
};

}  // namespace core::simulation
