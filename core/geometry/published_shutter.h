#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types/vector2.h"

namespace core {

// Choice of the velocity V_rel in Eq. 8.
enum class ShutterVelocity : std::uint8_t { kCamera, kRegion };

// Rolling shutter correction of Yoon et al. 2017 (Eqs. 7-8): line i is read t_r (i - 1) after the first, t_r = 1 / (f_s
// h), so the whole frame time is taken as readout; its shift is that time times V_rel, "the relative velocity ...
// between the camera and the structure", "obtained by the optical-flow using each sequential image frame". This is one
// velocity per image (kCamera): the mean flow of the points that show the camera's motion alone, `follows`. Points at
// line v then show the camera at the instant of line 0, and the structure at the instant of their own line. kRegion
// takes V_rel as the velocity of each region, which refers its points to line 0 completely. One thread; does not
// allocate after construction.
class PublishedShutter {
 public:
  struct Region {
    std::size_t begin = 0, end = 0;  // range of the points
    bool follows = true;             // its flow is (part of) the camera's
  };

  PublishedShutter() = default;
  PublishedShutter(ShutterVelocity velocity, std::vector<Region> regions, std::size_t n_points);

  // motion: of the points since the keyframe, px, corrected in place; readout_share: of their lines, 0 .. 1. If the
  // previous frame (by sequence) is missing, the mean velocity since the last frame is used.
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
  std::vector<Vector2> last_;  // kCamera: motion of each point; kRegion: mean motion of each region
  std::vector<std::uint8_t> has_last_;
};

}  // namespace core
