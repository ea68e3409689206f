#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/simulation/scene.h"

namespace tools {

// Seconds of the recorded flight (data set phantom4_hover) that are its hover.
inline constexpr double kHoverFrom_s = 360.7, kHoverTo_s = 440.0;

// The recorded hover, its path times `scale`, from an instant of its record on that is drawn from the seed, back and
// forth: of seeds 20 k + 1 ... 20 k + 20 each begins in another twentieth of the way there and back.
[[nodiscard]] std::shared_ptr<const core::simulation::RecordedMotion> recorded_hover(const std::string& path,
                                                                                     double scale, std::uint64_t seed,
                                                                                     double duration_s);

}  // namespace tools
