#include <fmt/format.h>

#include "tools/hovermodal/plan/words.h"

namespace tools {

std::string plan_yaml(const core::planning::PlanInput& input, const core::planning::HoverPlan& plan) {
  const core::planning::PlannedCamera& camera = input.camera;
  std::string out = fmt::format(
      "# for the service's configuration; camera.source and regions are still missing\n"
      "camera:\n"
      "  rate_hz: {:.10g}\n"
      "  readout_ms: {:.10g}\n"
      "  readout_direction: {}\n"
      "  exposure_ms: {:.10g}\n",
      camera.rate_hz, 1e3 * camera.readout_s, to_string(camera.direction), 1e3 * camera.exposure_s);
  out += fmt::format(
      "tracking:\n"
      "  points_per_region: {}\n"
      "spectrum:\n"
      "  segment: {}\n",
      input.points_per_region, plan.segment);
  if (plan.max_frequency_hz > 0.5 * camera.rate_hz)
    out += fmt::format("identification:\n  max_frequency_hz: {:g}\n", plan.max_frequency_hz);
  return out;
}

}  // namespace tools
