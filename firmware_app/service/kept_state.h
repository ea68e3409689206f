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

// What a kept state must agree with.
[[nodiscard]] RunState view_of(const AppConfig& config, const Source& source);
[[nodiscard]] std::string state_path(const AppConfig& config);     // empty: none is kept
[[nodiscard]] std::string keyframe_path(const AppConfig& config);  // beside it
// Keeps the keyframe for a later run; tells in health what became of the last one's, and a failure.
void keep_keyframe(const AppConfig& config, const Source& source, HealthCollector& health);
// Goes on with the state found at `path`; says so, or why not, in health. That state, its boot_id empty where the clock
// behind the stamps is another one; empty: the record begins anew.
[[nodiscard]] std::optional<RunState> resume_state(const std::string& path, const RunState& view,
                                                   SpectrumAccumulator& spectra, ModeIdentification& modes,
                                                   HealthCollector& health);

}  // namespace app
