#pragma once

#include <cstdint>
#include <vector>

#include "core/tracking/klt/interpolated_window.h"
#include "core/types/vector2.h"

namespace core {

struct KltConfig {
  int window_px = 21;  // side of the window that is compared, 5 ... 21
  int max_iterations = 12;
  double epsilon_px = 0.01;         // stop when a step is shorter, or shorter than half the effect of 8-bit rounding
  double reach_px = 8.0;            // a point farther from its prediction is not found here
  double least_correlation = 0.75;  // with the template, relative to what its noise allows
};

// Why a point is not seen in an image: its window leaves the image; the light is too different; its window shows
// something else (covered, or another surface in part of it), so that it is not found within reach or matches badly.
enum class PointLoss : std::uint8_t { kNone, kLeftImage, kLight, kUnlike };

// One point in one image.
struct KltPoint {
  Vector2 position;            // px
  double sigma_px = 0.0;       // standard deviation per axis over images against one template (core/tracking/METHOD.md)
  double gain = 1.0;           // of the light, against the template
  double deformed_px = 0.0;    // what the deformation would have added to sigma_px
  double residual = 0.0;       // variance per pixel after gain and offset, grey^2, with what the deformation adds
  double residual_unit = 0.0;  // of it, for one of DeformationResponse::energy
  bool seen = false;
  PointLoss loss = PointLoss::kNone;
};

// Whether its position in other images can be determined.
[[nodiscard]] bool is_trackable(const GrayView& gray, const Vector2& point, int window_px);

// Points of a keyframe in later images, each near its prediction: inverse-compositional Lucas-Kanade against a template
// (point_template.h), always the keyframe's, never frame to frame, so errors do not add up to drift. The same bits on
// every machine. After set_keyframe() nothing allocates. One thread.
class KltTracker {
 public:
  explicit KltTracker(const KltConfig& config) : config_(config) {}

  // Throws std::invalid_argument unless the image is 8-bit grey and not empty.
  void set_keyframe(const GrayView& gray, const std::vector<Vector2>& points);
  [[nodiscard]] std::size_t n_points() const noexcept { return points_.size(); }
  [[nodiscard]] const PointTemplate& point_template(std::size_t i) const noexcept { return points_[i].pattern; }

  // Replaces the template by the mean of `n_averaged` aligned images, with less noise; the reference position stays.
  // deformation: mean of these images'.
  void replace_template(std::size_t i, const Patch& mean, int n_averaged, const Deformation& deformation = {}) noexcept;
  // Template from another image, about the pixel nearest to place + beside; the point is at `place` there. The image is
  // deformed as set_deformation() said last. False, without effect: the window leaves the image, or noise would move
  // the point by more than that variance.
  [[nodiscard]] bool renew(std::size_t i, const GrayView& gray, const Vector2& place, const Vector2& beside,
                           double most_variance_px2) noexcept;
  // Subtracts `less` from the displacement of the point: shifts its reference position.
  void shift_datum(std::size_t i, const Vector2& less) noexcept;
  // How the image about the point is deformed against the keyframe, from here on: find() corrects for it. `found` in
  // this image: corrected, too.
  void set_deformation(std::size_t i, const Deformation& now, KltPoint& found) noexcept;
  [[nodiscard]] const Deformation& deformation(std::size_t i) const noexcept { return points_[i].deformation; }
  // Position of the template's middle when the point is at `position`.
  [[nodiscard]] Vector2 middle_of(std::size_t i, const Vector2& position) const noexcept;

  // gray: 8-bit, of any size. Not seen: no texture, window leaves the image, too far away, or correlation too low.
  [[nodiscard]] KltPoint find(const GrayView& gray, std::size_t i, const Vector2& predicted) noexcept;

 private:
  struct Point {
    PointTemplate pattern;
    Vector2 datum;              // where the point is while the pattern's middle is at (u0, v0)
    double u0 = 0.0, v0 = 0.0;  // a pixel
    double gain = 1.0;          // when last seen
    double least_correlation = 0.0;
    Deformation reference, deformation;  // of the template and of the image, against the keyframe
    Vector2 correction;                  // from where the template is found to where the point is, beyond the datum

    [[nodiscard]] Vector2 beside() const noexcept { return {datum.u - u0, datum.v - v0}; }
  };

  void judge_texture(Point& point) const noexcept;
  static void correct(Point& point) noexcept;
  static void state_sigma(const Point& point, KltPoint& found) noexcept;
  [[nodiscard]] double gain_here(double otherwise) const noexcept;

  KltConfig config_;
  std::vector<Point> points_;
  InterpolatedWindow window_;
};

}  // namespace core
