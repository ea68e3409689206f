#pragma once

#include <functional>

#include "firmware_app/config/config.h"
#include "firmware_app/service/pipeline.h"

namespace app {

// Residual diagnosis over all levels of a run that has ended, from its report folder (firmware_app/replay/level_loop.h):
// loop.json and loop.html in it, and the table in the log. Nothing without a report, without tracks in it, or with
// closure.adopt: off. Never throws: why there is no result is logged. Takes up to a minute; `goes_on` is asked every few
// seconds, and false ends it without a result.
void diagnose_run(const AppConfig& config, const Pipeline::Outcome& outcome, const std::function<bool()>& goes_on);

}  // namespace app
