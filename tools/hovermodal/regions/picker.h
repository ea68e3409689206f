#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/types/region.h"

namespace tools {

struct PickerOptions {
  std::string out;  // where Save writes the regions: block
  int port = 0;     // 0: any free port
  int width_px = 0, height_px = 0;
};

// The regions that a page sends as JSON, {"regions": [{"name", "rect": [u, v, w, h], "role", "axis"}, ...]}. Throws
// std::invalid_argument that names the fault; the text is shown beside the button.
[[nodiscard]] std::vector<core::Region> read_regions(std::string_view json, int width_px, int height_px);
// The inverse, with "size": [width, height].
[[nodiscard]] std::string regions_json(const std::vector<core::Region>& regions, int width_px, int height_px);

// Serves a page on this computer alone, on which the regions are moved by mouse, finger or keyboard, until SIGINT or
// SIGTERM. Throws std::runtime_error if this build has no web server.
void run_picker(const std::vector<core::Region>& regions, const std::string& frame_png, const PickerOptions& options);

}  // namespace tools
