#pragma once

#include <functional>
#include <optional>

#include "core/structure/declared_frame.h"
#include "firmware_app/config/config.h"
#include "firmware_app/service/pipeline.h"

namespace app {

// Reads the structure that closure.structure names; empty: none is named. Takes seconds for a large model. Throws
// ConfigError with the file's own words.
[[nodiscard]] std::optional<core::structure::DeclaredFrame> declared_structure(const AppConfig& config);

// Residual diagnosis over all levels of a run that has ended, from its report folder
// (firmware_app/replay/level_loop.h), and of its declared structure: writes loop.json and loop.html to it, and the
// table to the log. Does nothing without a report, without tracks in it, or with closure.adopt: off. Never throws: a
// failure is logged. Takes up to a minute; `goes_on` is called every few seconds; when it returns false, the diagnosis
// ends without a result.
void diagnose_run(const Pipeline& pipeline, const Pipeline::Outcome& outcome, const std::function<bool()>& goes_on);

}  // namespace app
