#pragma once

#include <cstdint>
#include <string>

#include "tools/validate/trust_scene.h"

namespace tools {

// A camera that shakes, in addition to the hover of a flight:
//   gimbal   4 ... 9 Hz, 0.02 ... 0.1 degrees rms about each axis
//   turns    yaw and pitch, slow, 1 degree rms
//   gusts    displacement to the side of 1 ... 4 mm rms: the response of an aircraft that holds its place, an
//            oscillator of 0.4 ... 1.2 Hz, to the force on the structure's uppermost body (wind), or to a force of its
//            own (a shaken base)
// The focal length is reduced until the structure stays within the image. Returns the drawn values, in words.
std::string shake_camera(TrustFlight& flight, Drive drive, std::uint64_t seed);

}  // namespace tools
