#pragma once

#include <cstddef>
#include <vector>

#include "core/types/vector2.h"

namespace core {

// Degrees from +u towards +v, -90 .. 90, of the line along which a part vibrates; one of the image's axes when near it.
// Where the spectrum of its motion has peaks far above what lies beside them, it is the line of the motion in these
// peaks: a part at another distance than the static region also moves by the camera's translation, whose spectrum is
// smooth. Without peaks: the line along which it moves most. motion: px, one per frame; slow_frames: what takes longer
// was removed from it.
[[nodiscard]] double vibration_axis_deg(const std::vector<Vector2>& motion, std::size_t slow_frames);

}  // namespace core
