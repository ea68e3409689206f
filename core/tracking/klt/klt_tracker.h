#pragma once

#include <cstdint>
#include <vector>

#include "core/tracking/klt/phase_match.h"
#include "core/tracking/klt/point_template.h"
#include "core/tracking/klt/window_sums.h"
#include "core/types/vector2.h"

namespace core {

struct KltConfig {
  int window_px = 21;  // side of the compared window, 5 ... 21
  int max_iterations = 12;
  double reach_px = 8.0;            // largest distance from the prediction at which a point is found
  double least_correlation = 0.75;  // with the template, relative to the value expected from its noise
};

// Why a point is not seen in an image: its window leaves the image; the light is too different; its window shows
// something else (covered, or another surface in part of it), so that it is not found within reach or matches badly.
enum class PointLoss : std::uint8_t { kNone, kLeftImage, kLight, kUnlike };

// Where a template was found: displaced from one of its phases, which are thirds of a pixel.
struct PhasePlace {
  std::uint8_t u = 0, v = 0;
  Vector2 off;  // px
};

// One point in one image.
struct KltPoint {
  Vector2 position;            // px
  double sigma_px = 0.0;       // per axis, over images against one template (core/tracking/METHOD.md)
  double gain = 1.0;           // brightness gain relative to the template
  double deformed_px = 0.0;    // contribution to sigma_px if the deformation were not corrected
  double residual = 0.0;       // variance per pixel after gain and offset, grey^2, including the effect of deformation
  double residual_unit = 0.0;  // residual per unit of DeformationEnergy
  PhasePlace phase;
  Vector2 correction;  // for deformation, in the position, px
  bool seen = false;
  PointLoss loss = PointLoss::kNone;
};

// True if the point's position in other images can be determined.
[[nodiscard]] bool is_trackable(const GrayView& gray, const Vector2& point, int window_px);

// Finds points of a keyframe in later images, each near its prediction: inverse-compositional Lucas-Kanade against a
// template (point_template.h). The template is always that of the keyframe, never of the last frame, so errors do not
// accumulate to drift. Bit-identical on every machine. Does not allocate after set_keyframe().
class KltTracker {
 public:
  explicit KltTracker(const KltConfig& config) : config_(config) {}

  // Throws std::invalid_argument unless the image is 8-bit grey and not empty.
  void set_keyframe(const GrayView& gray, const std::vector<Vector2>& points);
  [[nodiscard]] std::size_t n_points() const noexcept { return points_.size(); }
  [[nodiscard]] const PointTemplate& point_template(std::size_t i) const noexcept { return points_[i].pattern; }

  // Replaces the template by the mean of `n_averaged` aligned images, which has less noise; the reference position
  // stays. deformation: mean over these images.
  void replace_template(std::size_t i, const Patch& mean, int n_averaged, const Deformation& deformation = {}) noexcept;
  // Cuts a template from another image, about the pixel nearest to place + beside; the point is at `place` in that
  // image, whose deformation is that of the last set_deformation(). False, without effect: the window leaves the image,
  // or noise would displace the point by more than that variance.
  [[nodiscard]] bool renew(std::size_t i, const GrayView& gray, const Vector2& place, const Vector2& beside,
                           double most_variance_px2) noexcept;
  // Subtracts `less` from the displacement of the point by shifting its reference position.
  void shift_datum(std::size_t i, const Vector2& less) noexcept;
  // Sets the deformation of the image about the point relative to the keyframe; find() corrects for it from now on.
  // `found`: result in this image, which is corrected, too.
  void set_deformation(std::size_t i, const Deformation& now, KltPoint& found) noexcept;
  [[nodiscard]] const Deformation& deformation(std::size_t i) const noexcept { return points_[i].deformation; }
  // Position of the template's centre when the point is at `position`.
  [[nodiscard]] Vector2 middle_of(std::size_t i, const Vector2& position) const noexcept;

  // Fetches into the cache what find() of this point will read.
  void prefetch(const GrayView& gray, std::size_t i, const Vector2& predicted) const noexcept;
  // gray: 8-bit, any size. Not seen: no texture, window leaves the image, too far away, or correlation too low.
  [[nodiscard]] KltPoint find(const GrayView& gray, std::size_t i, const Vector2& predicted) noexcept;

 private:
  struct Point {
    PointTemplate pattern;
    Vector2 datum;              // position of the point while the pattern's centre is at (u0, v0)
    double u0 = 0.0, v0 = 0.0;  // a whole pixel
    double gain = 1.0;          // at the last detection
    double least_correlation = 0.0;
    Deformation reference, deformation;  // of the template and of the image, relative to the keyframe
    Vector2 correction;                  // offset from the found template to the point, in addition to the datum
    double deformed_energy = 0.0;        // of the deformation, grey^2
    PhasePlace phase;                    // at the last detection

    [[nodiscard]] Vector2 beside() const noexcept { return {datum.u - u0, datum.v - v0}; }
  };

  // Where the template's centre would be with the point at `position`, px.
  [[nodiscard]] static Vector2 centre_at(const Point& point, const Vector2& position) noexcept {
    return {position.u - point.datum.u + point.u0 - point.correction.u,
            position.v - point.datum.v + point.v0 - point.correction.v};
  }
  void judge_texture(Point& point) const noexcept;
  static void note_deformation(Point& point, const Deformation& now) noexcept;
  [[nodiscard]] static Vector2 correction(const Point& point) noexcept;
  static void state_sigma(const Point& point, KltPoint& found) noexcept;
  void accept(Point& point, const PhaseMatch& match, const Vector2& place, KltPoint& out) const noexcept;

  KltConfig config_;
  std::vector<Point> points_;
  RawWindow window_{};
};

}  // namespace core
