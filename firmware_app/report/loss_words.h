#pragma once

#include <cstddef>
#include <string>

#include "core/tracking/structure_tracker.h"

namespace app {

// "12 of 240 points are lost: 9 covered or with another surface in their window, 3 outside the image". Empty: none.
[[nodiscard]] std::string point_loss_words(const core::PointLosses& losses, std::size_t n_points);

}  // namespace app
