#pragma once

#include <optional>
#include <string>

#include "firmware_app/chain/mode_identification.h"
#include "firmware_app/chain/spectrum_accumulator.h"
#include "firmware_app/chain/state/run_state.h"
#include "firmware_app/config/config.h"
#include "firmware_app/service/health.h"
#include "firmware_app/service/source.h"

namespace app {

// Properties with which a kept state must agree.
[[nodiscard]] RunState view_of(const AppConfig& config, const Source& source);
[[nodiscard]] std::string state_path(const AppConfig& config);     // empty: none is kept
[[nodiscard]] std::string keyframe_path(const AppConfig& config);  // beside it
// Keeps the keyframe for a later run; health reports whether the earlier one was used, and a failure.
void keep_keyframe(const AppConfig& config, const Source& source, HealthCollector& health);
// Resumes from the state found at `path`; health reports success or why not. Returns the state resumed from, or empty
// where there is none. Its boot_id is empty if the time stamps since then are on another clock.
[[nodiscard]] std::optional<RunState> resume_state(const std::string& path, const RunState& view,
                                                   SpectrumAccumulator& spectra, ModeIdentification& modes,
                                                   HealthCollector& health);

}  // namespace app
