#pragma once

#include <optional>
#include <vector>

#include "core/tracking/region_survey.h"
#include "core/types/region.h"

namespace core {

struct Box {
  double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
  [[nodiscard]] double width() const noexcept { return right - left; }
  [[nodiscard]] double height() const noexcept { return bottom - top; }
  [[nodiscard]] bool holds(const Vector2& at) const noexcept {
    return at.u >= left && at.u <= right && at.v >= top && at.v <= bottom;
  }
};

// The rectangle that holds the most resting points and neither a point that moves otherwise nor a piece of what is
// forbidden, with a margin about it; no larger than half the picture's width and height. Empty when there is none.
[[nodiscard]] std::optional<Box> rest_rectangle(const std::vector<SurveyedPoint>& points,
                                                const std::vector<bool>& rests, const std::vector<Region>& forbidden,
                                                int width_px, int height_px);

}  // namespace core
