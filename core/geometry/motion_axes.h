#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/types/region.h"
#include "core/types/track.h"
#include "core/types/vector2.h"

namespace core {

// Mean square motion of a region in the image, px^2, the tracker's noise taken away; noise_px2: that of one axis.
struct PlaneMotion {
  double uu = 0.0, uv = 0.0, vv = 0.0, noise_px2 = 0.0;
  std::uint64_t n_samples = 0;
  [[nodiscard]] double along_px(double axis_deg) const noexcept;  // rms
  [[nodiscard]] double across_px(double axis_deg) const noexcept { return along_px(axis_deg + 90.0); }
  [[nodiscard]] double principal_deg() const noexcept;  // (-90, 90]; direction of the largest motion
};

// In which direction of the image each region moves, whatever axis it has: median motion of its points, less the
// camera's shift and zoom, less what is slower than a block of time (its line fitted). The camera's motion is that of
// what lies still in the structure's plane; else the median of the regions that move, of two or more, so that only
// motion against one another counts; else that of the background. Raw pixels: neither lens nor perspective matter for a
// direction. One thread; nothing allocates after construction.
class MotionAxes {
 public:
  MotionAxes(const std::vector<Region>& regions, std::size_t n_points);

  // The next frame; points of the same number in every one. A point is measured from where it is seen first.
  void add(const TrackFrame& frame) noexcept;

  // Of all blocks that are complete.
  [[nodiscard]] PlaneMotion motion(std::size_t region) const noexcept;
  [[nodiscard]] std::size_t n_regions() const noexcept { return roles_.size(); }
  [[nodiscard]] double duration_s() const noexcept { return duration_s_; }  // from the first frame to the last one

 private:
  enum class Reference : std::uint8_t { kGround, kEachOther, kBackground, kNone };
  // Sums over a block of time: of t and both components, for their line.
  struct Line {
    double n = 0.0, t = 0.0, tt = 0.0;
    Vector2 x, tx;
    double uu = 0.0, uv = 0.0, vv = 0.0, noise = 0.0;
    void add(double t_s, const Vector2& value, double noise_px2) noexcept;
  };
  struct Seen {
    Vector2 motion, place;
    double noise_px2 = 0.0;
    bool valid = false;
  };
  // Of the points about the middle of their region: least squares.
  struct ZoomSums {
    double along = 0.0, spread = 0.0, noise = 0.0;
  };

  void see(const TrackFrame& frame) noexcept;
  void see_zoom(const TrackFrame& frame, std::size_t begin, std::size_t end, const Seen& region,
                double variance_px2) noexcept;
  [[nodiscard]] std::optional<Vector2> middle() const noexcept;
  [[nodiscard]] Vector2 camera() noexcept;
  void remove_zoom(const Vector2& middle) noexcept;
  [[nodiscard]] double growth(const Vector2& middle) const noexcept;
  [[nodiscard]] bool is_reference(std::size_t region) const noexcept;
  void end_block() noexcept;

  std::vector<RegionRole> roles_;
  Reference reference_ = Reference::kNone;
  double block_s_ = 1.0, duration_s_ = 0.0;
  std::optional<std::int64_t> first_ns_;
  double block_begin_s_ = 0.0;
  std::vector<Vector2> first_;          // of each point, where it was seen first
  std::vector<std::uint8_t> is_known_;  // whether it was
  std::vector<Seen> seen_;              // regions, in the frame at hand
  ZoomSums zoom_;                       // of the frame at hand
  std::vector<double> u_, v_;           // scratch
  std::vector<Line> lines_;             // regions, of the block at hand
  std::vector<PlaneMotion> sums_;       // regions, over complete blocks, not yet divided
};

// The axis of each region from its motion. Regions whose own motion has no clear direction take that of all together;
// both axes where these move along either; u where nothing moves.
struct AxisChoice {
  AxisFrom from = AxisFrom::kNoMotion;
  double axis_deg = 0.0;
  bool both_axes = false;
};
[[nodiscard]] std::vector<AxisChoice> choose_axes(const MotionAxes& axes, const std::vector<Region>& regions);
// More frames would hardly change it: all together move along one axis, far above the noise.
[[nodiscard]] bool is_axis_clear(const MotionAxes& axes, const std::vector<Region>& regions);

}  // namespace core
