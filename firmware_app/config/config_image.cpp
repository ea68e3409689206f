#include "firmware_app/config/config_image.h"

#include <fmt/format.h>

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
  const auto require_seen = [&](const std::string& key, double u_px, double v_px) {
    if (u_px >= 0.0 && v_px >= 0.0 && u_px <= width_px - 1.0 && v_px <= height_px - 1.0) return;
    throw ConfigError(
        fmt::format("{}: [{}, {}] is refused: allowed inside the image of {} x {} px; name a point that is seen", key,
                    u_px, v_px, width_px, height_px));
  };
  const ScaleConfig& scale = config.scale;
  if (scale.known_length_mm != 0.0) {
    require_seen("scale.from", scale.from_px[0], scale.from_px[1]);
    require_seen("scale.to", scale.to_px[0], scale.to_px[1]);
  }
  for (const auto& row : scale.lengths) {
    require_seen("scale.lengths", row[0], row[1]);
    require_seen("scale.lengths", row[2], row[3]);
  }
  for (const auto& row : scale.points) require_seen("scale.points", row[0], row[1]);
  for (std::size_t i = 0; i < config.regions.size(); ++i) {
    const core::Region& region = config.regions[i];
    if (region.length_mm == 0.0) continue;
    require_seen(fmt::format("regions.{}.length", i), region.length_from_px.u, region.length_from_px.v);
    require_seen(fmt::format("regions.{}.length", i), region.length_to_px.u, region.length_to_px.v);
  }
}

}  // namespace app
