#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/simulation/scene.h"

namespace tools {

// The hover within the recorded flight (data set phantom4_hover), in seconds.
inline constexpr double kHoverFrom_s = 360.7, kHoverTo_s = 440.0;

// The recorded hover, its path multiplied by `scale`, starting at an instant drawn from the seed, played back and
// forth: seeds 20 k + 1 ... 20 k + 20 each begin in another twentieth of one forward and backward pass.
[[nodiscard]] std::shared_ptr<const core::simulation::RecordedMotion> recorded_hover(const std::string& path,
                                                                                     double scale, std::uint64_t seed,
                                                                                     double duration_s);

}  // namespace tools
