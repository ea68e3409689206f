#pragma once

#include <vector>

#include "core/planning/hover_plan.h"

namespace core::planning {

// Properties of aliasing that depend on the camera alone.
struct FoldSurvey {
  std::vector<FoldPlace> places;  // per mode
  std::vector<Overlap> overlaps;
  double delay_span_frames = 0.0;
};
[[nodiscard]] FoldSurvey survey_folds(const PlanInput& input, const PlannedCamera& camera);

[[nodiscard]] bool fits(const PlanInput& input, const PlannedCamera& camera) noexcept;
[[nodiscard]] double highest_frequency_hz(const PlanInput& input) noexcept;

// Result as in HoverPlan::options.
[[nodiscard]] std::vector<CameraOption> camera_options(const PlanInput& input);
[[nodiscard]] std::size_t best_option(const std::vector<CameraOption>& options) noexcept;

}  // namespace core::planning
