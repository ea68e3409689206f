#pragma once

#include <string>

#include "core/types/loop_result.h"

namespace app {

// Residual diagnosis over all levels, for a terminal: one table of the levels, one of the modes.
[[nodiscard]] std::string loop_text(const core::closure::LoopResult& result);
// Text of loop.json: no wall clock, no paths; the same input gives the same bytes. Unknown is null.
[[nodiscard]] std::string loop_json(const core::closure::LoopResult& result);
// loop.html: the same tables on one page that needs no network, with a picture of the frequencies before and after and
// those of a declared structure.
[[nodiscard]] std::string loop_page(const core::closure::LoopResult& result);
// Writes loop.json and loop.html into a folder that exists. Throws drivers::FileError.
void write_loop_report(const std::string& directory, const core::closure::LoopResult& result);

}  // namespace app
