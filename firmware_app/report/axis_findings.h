#pragma once

#include <string>
#include <vector>

#include "core/geometry/motion_axes.h"
#include "core/types/region.h"

namespace app {

// Regions that moved across their axis more than along it, in words, with the axis to set. One line for all regions of
// one direction. What hardly moves against the others (a base) is not judged.
[[nodiscard]] std::vector<std::string> motion_across_words(const std::vector<core::Region>& regions,
                                                           const core::MotionAxes& axes);

}  // namespace app
