#include "firmware_app/config_image.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>

namespace app {

void check_against_image(const AppConfig& config, int width_px, int height_px) {
  for (std::size_t i = 0; i < config.regions.size(); ++i) {
    const core::Region& region = config.regions[i];
    if (region.u_px >= 0.0 && region.v_px >= 0.0 && region.u_px + region.width_px <= width_px &&
        region.v_px + region.height_px <= height_px) {
      continue;
    }
    throw ConfigError(
        fmt::format("regions.{}.rect: [{}, {}, {}, {}] is refused: allowed inside the image of {} x {} px; region `{}` "
                    "reaches to x = {}, "
                    "y = {}: move or shrink it",
                    i, region.u_px, region.v_px, region.width_px, region.height_px, width_px, height_px, region.name,
                    region.u_px + region.width_px, region.v_px + region.height_px));
  }
  if (config.scale.known_length_mm == 0.0) return;
  const std::array<const std::array<double, 2>*, 2> ends{&config.scale.from_px, &config.scale.to_px};
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const auto& [u_px, v_px] = *ends[i];
    if (u_px >= 0.0 && v_px >= 0.0 && u_px <= width_px - 1.0 && v_px <= height_px - 1.0) continue;
    throw ConfigError(
        fmt::format("scale.{}: [{}, {}] is refused: allowed inside the image of {} x {} px; name a point that is seen",
                    i == 0 ? "from" : "to", u_px, v_px, width_px, height_px));
  }
}

}  // namespace app
