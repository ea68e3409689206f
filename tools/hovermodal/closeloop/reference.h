#pragma once

#include <string>
#include <vector>

#include "core/structure/declared_frame.h"

namespace tools {

// Modes of a modal.json (its structural ones, counted from the lowest; shapes where `declared.floors` names channels)
// or of a table: column frequency_hz or frequency_rad_s, optionally mode (number from 1), sigma_hz, and one column per
// floor. Throws drivers::FileError naming file, column and remedy.
[[nodiscard]] std::vector<core::structure::ReferenceMode> read_reference(
    const std::string& path, const core::structure::DeclaredFrame& declared);

}  // namespace tools
