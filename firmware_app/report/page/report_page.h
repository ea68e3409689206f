#pragma once

#include <string>

#include "firmware_app/report/pictures/pictures.h"

namespace app {

// The text of report.html: a run on one page, without external content (no network, no files), for phone and desktop,
// light and dark mode, below 2 MB. Needs `inputs.facts`; other missing inputs are stated in their section. The same
// input gives the same bytes, except between kVariesBegin and kVariesEnd: timing.
[[nodiscard]] std::string report_html(const PictureInputs& inputs);

inline constexpr const char* kReportName = "report.html";
inline constexpr const char* kVariesBegin = "<!-- differs from run to run: begin -->";
inline constexpr const char* kVariesEnd = "<!-- differs from run to run: end -->";

}  // namespace app
