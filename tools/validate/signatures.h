#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tools {

// One effect of the simulator compared with first-order theory.
struct SignatureCheck {
  std::string effect;
  double rms_px = 0.0;          // of tracks with it minus tracks without it
  double relative_error = 0.0;  // rms of the part not explained by the signature, over rms_px
};

// For each effect that moves tracks: the paper's scene without and with a small size of it, point by point and frame by
// frame. The signatures (ARCHITECTURE.md) are implemented here independently of core/simulation: the linear field of a
// small
// camera motion, the lens polynomial, velocity times a time error, the modal sum of a harmonic response.
[[nodiscard]] std::vector<SignatureCheck> check_signatures(std::uint64_t seed);

}  // namespace tools
