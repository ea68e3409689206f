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

// The rectangle with the most static points that contains no moving point and no part of the forbidden areas, with a
// margin; at most half the image's width and height. Empty if there is none.
[[nodiscard]] std::optional<Box> rest_rectangle(const std::vector<SurveyedPoint>& points,
                                                const std::vector<bool>& rests, const std::vector<Region>& forbidden,
                                                int width_px, int height_px);

}  // namespace core
