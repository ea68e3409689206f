#pragma once

#include <complex>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "core/types/vector2.h"

namespace core {

// A rectangle of the image that moves as a whole; edges in pixels, a pixel's centre at integers.
struct WarpPart {
  double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
  std::complex<double> swing_u, swing_v;  // amplitude in pixels: at phase p it is shifted by Re(swing e^(ip))
};

// Warps an image so that its parts swing: a mesh of kCellPx, each node shifted by the parts' shifts, weighted by the
// inverse cube of its distance from them (Shepard 1968); inside a part, exactly by the part's own. A part without a
// swing holds its place, and so does everything far from all parts: beyond kReachShare of the image's longer side the
// rest weighs more than a part. The inverse map, which drawing needs, is found by iteration on the mesh; between the
// nodes it is bilinear. One thread.
class MeshWarp {
 public:
  static constexpr int kCellPx = 4;
  static constexpr double kReachShare = 0.15;
  // Largest strain (difference of two neighbouring nodes' shifts per pixel) with which the image does not fold and the
  // iteration converges.
  static constexpr double kMostStrain = 0.6;

  // Throws std::invalid_argument: no size, no part, a part without area, a value that is not finite.
  MeshWarp(int width_px, int height_px, std::vector<WarpPart> parts);

  // Over all phases. Draw only below kMostStrain.
  [[nodiscard]] double strain() const noexcept { return strain_; }
  // Shift of the image's point `at`, at this phase.
  [[nodiscard]] Vector2 shift(const Vector2& at, double phase) const noexcept;
  // `gray`: CV_8UC1 of the constructed size. Where the map leads outside, the nearest pixel is taken.
  [[nodiscard]] cv::Mat draw(const cv::Mat& gray, double phase) const;

 private:
  [[nodiscard]] std::complex<double> swing(const Vector2& at, std::complex<double>& v) const noexcept;

  int width_px_, height_px_;
  std::vector<WarpPart> parts_;
  double rest_weight_;
  double strain_ = 0.0;
};

}  // namespace core
