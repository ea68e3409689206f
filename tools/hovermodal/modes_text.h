#pragma once

#include <string>
#include <vector>

#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace tools {

// Modes as a table for a terminal, rejected poles with their reasons below.
[[nodiscard]] std::string modes_text(const core::ModalEstimate& estimate,
                                     const std::vector<core::ChannelInfo>& channels);

// The same as modal.json has it, without what only a whole run knows.
[[nodiscard]] std::string modes_json(const core::ModalEstimate& estimate,
                                     const std::vector<core::ChannelInfo>& channels,
                                     const std::string& method = "hovermodal");

}  // namespace tools
