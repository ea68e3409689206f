#pragma once

#include <string>

#include "firmware_app/report/pictures/pictures.h"

namespace app {

// The text of report.html: all of a run on one page for people, with nothing outside of it (no network, no files), for
// a phone and a desk, light and dark, below 2 MB. Needs `inputs.facts`. What else is missing is told in its section.
// The same input gives the same bytes, but for what stands between kVariesBegin and kVariesEnd: how long things took.
[[nodiscard]] std::string report_html(const PictureInputs& inputs);

inline constexpr const char* kReportName = "report.html";
inline constexpr const char* kVariesBegin = "<!-- differs from run to run: begin -->";
inline constexpr const char* kVariesEnd = "<!-- differs from run to run: end -->";

}  // namespace app
