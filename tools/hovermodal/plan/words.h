#pragma once

#include <string>

#include "core/planning/hover_plan.h"

namespace tools {

// The whole plan for a terminal: tables, advice, configuration fragment.
[[nodiscard]] std::string plan_text(const core::planning::PlanInput& input, const core::planning::HoverPlan& plan);

// One paragraph: what to expect and what to do.
[[nodiscard]] std::string plan_advice(const core::planning::PlanInput& input, const core::planning::HoverPlan& plan);

// Part of the service's configuration for this camera and hover, as YAML; source and regions are still missing.
[[nodiscard]] std::string plan_yaml(const core::planning::PlanInput& input, const core::planning::HoverPlan& plan);

// plan.json; unknown is null.
[[nodiscard]] std::string plan_json(const core::planning::PlanInput& input, const core::planning::HoverPlan& plan);

// plan.svg: expected spectrum and noise floor, and below it the apparent frequency of every true frequency.
[[nodiscard]] std::string plan_svg(const core::planning::PlanInput& input, const core::planning::HoverPlan& plan);

[[nodiscard]] const char* to_text(core::planning::FoldOutlook outlook) noexcept;

// "mode 5", "modes 5 and 6", "modes 2, 5 and 6"; the numbers count from 1.
[[nodiscard]] std::string mode_list(const std::vector<std::size_t>& indices);

}  // namespace tools
