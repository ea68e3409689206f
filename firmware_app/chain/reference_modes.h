#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/structure/declared_frame.h"
#include "core/types/modal_estimate.h"

namespace app {

// Indices of the channels that `declared.floors` names, in its order. Throws std::invalid_argument naming a channel
// that does not exist, and those that do.
[[nodiscard]] std::vector<std::size_t> floor_channels(const core::structure::DeclaredFrame& declared,
                                                      const std::vector<std::string>& channel_names);

// Scales the largest component of the shape to 1, and the sigmas accordingly.
void normalise(core::structure::ReferenceMode& mode);

// The structural modes of an estimate, numbered from the lowest, for comparison with a declared structure; with shapes
// where `declared.floors` names channels. Throws std::invalid_argument as floor_channels().
[[nodiscard]] std::vector<core::structure::ReferenceMode> reference_modes(
    const core::ModalEstimate& estimate, const std::vector<std::string>& channel_names,
    const core::structure::DeclaredFrame& declared);

}  // namespace app
