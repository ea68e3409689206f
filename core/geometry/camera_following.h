#pragma once

#include <cstdint>

namespace core {

// What is removed from the points of the camera's motion.
enum class CameraFollowing : std::uint8_t {
  kDistance,  // its distance alone (paper, Eq. 6); a static region witnesses the rest
  kSlow,  // and its slow rotation (slow_rotation.h), where a static region shows it and a focal length is known; the
          // region witnesses what is left
  kWhole,
};

// A measured attitude is the whole rotation, not the slow part alone.
[[nodiscard]] constexpr CameraFollowing following_with(CameraFollowing asked, bool has_attitude) noexcept {
  return asked == CameraFollowing::kSlow && has_attitude ? CameraFollowing::kWhole : asked;
}

}  // namespace core
