#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types/vector2.h"

namespace core {

// Whose velocity the V_rel of Eq. 8 is.
enum class ShutterVelocity : std::uint8_t { kCamera, kRegion };

// The rolling shutter as Yoon et al. 2017 undo it (Eqs. 7-8): line i is read t_r (i - 1) after the first, t_r = 1 /
// (f_s h), so the whole frame time is taken to be readout; its shift is that times V_rel, "the relative velocity ...
// between the camera and the structure", "obtained by the optical-flow using each sequential image frame". That is one
// velocity per image (kCamera): the mean flow of the points on what moves with the camera's view alone, `follows`.
// Points at line v then show the camera where it was at the frame's line 0, and the structure where it was at their own
// line. kRegion reads V_rel as each region's own, which moves its points to line 0 altogether. One thread; nothing
// allocates after construction.
class PublishedShutter {
 public:
  struct Region {
    std::size_t begin = 0, end = 0;  // of the points
    bool follows = true;             // its flow is (part of) the camera's
  };

  PublishedShutter() = default;
  PublishedShutter(ShutterVelocity velocity, std::vector<Region> regions, std::size_t n_points);

  // motion: of the points since the keyframe, px, corrected in place; readout_share: of their lines, 0 .. 1. A frame
  // without the one before it (by sequence) is corrected by the mean velocity since the last.
  void correct(std::uint64_t sequence, std::span<const double> readout_share, std::span<const std::uint8_t> inlier,
               std::span<Vector2> motion) noexcept;

 private:
  void correct_by_camera(double n_frames, std::span<const double> share, std::span<const std::uint8_t> inlier,
                         std::span<Vector2> motion) noexcept;
  void correct_by_region(double n_frames, std::span<const double> share, std::span<const std::uint8_t> inlier,
                         std::span<Vector2> motion) noexcept;

  ShutterVelocity velocity_ = ShutterVelocity::kCamera;
  std::vector<Region> regions_;
  std::uint64_t last_sequence_ = 0;
  std::vector<Vector2> last_;  // kCamera: of each point; kRegion: of each region's mean
  std::vector<std::uint8_t> has_last_;
};

}  // namespace core
