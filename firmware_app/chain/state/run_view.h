#pragma once

#include <vector>

#include "core/types/displacement.h"
#include "core/types/frame.h"
#include "firmware_app/chain/state/run_state.h"
#include "firmware_app/config/config.h"

namespace app {

// Properties that the checkpoint or record of another run must share; no boot, no sums.
[[nodiscard]] RunState run_view(const AppConfig& config, const core::CameraInfo& camera,
                                const std::vector<core::ChannelInfo>& channels);

}  // namespace app
