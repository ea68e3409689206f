#pragma once

#include <string>

#include "core/closure/closure_loop.h"
#include "core/types/closure_result.h"
#include "tools/hovermodal/answer.h"

namespace tools {

// The loop of one level, with its progress. Throws as core::closure::close_loop() does.
[[nodiscard]] core::closure::ClosureResult close_level(const Answer& answer, core::closure::ClosureLevel& level,
                                                       core::closure::ClosureOptions options);

// What every form of closeloop leaves of a result: its JSON (--json) or its text followed by `more`, and in the folder
// `report`, unless that is empty, the JSON as `file`. Another file than closure.json is one result of several, which
// --json does not print. Throws drivers::FileError.
void show_closure(const Answer& answer, const core::closure::ClosureResult& result, const std::string& more,
                  const std::string& report, const std::string& file = "closure.json");

// The files of an earlier closure.json and its pictures in `report` move to `report`/closure.1. An empty `report` is
// none.
void keep_earlier_closure(const std::string& report);

}  // namespace tools
