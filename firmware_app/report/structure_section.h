#pragma once

#include <string>

#include "core/types/closure_result.h"
#include "core/types/loop_result.h"

namespace app {

// The errors of the modes as bars, before and after, in the widths of a screen and of a phone; empty: there are none.
[[nodiscard]] std::string modes_figure_html(const core::closure::ClosureResult& drawn, const std::string& axis);

// The declared structure against the modes: errors before and after, shapes, the structure with what was found,
// parameters. A section of a page; empty if none was compared.
[[nodiscard]] std::string structure_section(const core::closure::LoopResult& result);

// A report page with that section, in front of the losses and in the list of sections, in place of an earlier one.
// Without a section, or if it is not a page of a report: the page as it is.
[[nodiscard]] std::string with_structure_section(const std::string& page, const std::string& section);
// The same of report.html in a run's folder, where there is one. Throws drivers::FileError.
void add_structure_to_report(const std::string& directory, const core::closure::LoopResult& result);

}  // namespace app
