#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/motion_axes.h"
#include "core/types/region.h"
#include "firmware_app/config/config.h"

namespace app {

// regions[].axis. `auto`: to be found before the run begins; once found it reads `auto 90`, `auto both`, or, where
// nothing moved, `auto still`, so that a run's record and its tracks.csv say what was measured, and that it was found.
// False: no axis.
[[nodiscard]] bool put_axis(std::string_view text, core::Region& region);
[[nodiscard]] std::string axis_key_text(const core::Region& region);  // what put_axis() takes
// "u", "v", "both", "30 degrees": for readers.
[[nodiscard]] std::string axis_words(const core::Region& region);
[[nodiscard]] std::string axis_origin(const core::Region& region);  // "declared", "motion", "assumed"
// A region that reads so. Unknown words: as declared along u.
[[nodiscard]] core::Region region_with_axis(std::string name, std::string_view words, std::string_view origin);

[[nodiscard]] core::Region undeclared_region();  // of a configuration, before its keys are read
[[nodiscard]] bool seeks_axes(const AppConfig& config);
void take_axes(AppConfig& config, const std::vector<core::AxisChoice>& found);  // where they are sought; one a region
// Axes that another configuration of the same regions has, by the regions' names, where they are sought.
void take_axes_of(AppConfig& config, const std::vector<core::Region>& others);
// What is left to be found is u. For a record of a program that took u where no axis was declared.
void take_u_where_sought(AppConfig& config);
// One line for the log: "axis of floor1, floor2: u (found from their motion)". Empty: all are declared.
[[nodiscard]] std::string found_axes_words(const AppConfig& config);
// What a reader must know: nothing moved, so that u was taken, or nobody looked.
[[nodiscard]] std::vector<std::string> axis_caveats(const AppConfig& config);

}  // namespace app
