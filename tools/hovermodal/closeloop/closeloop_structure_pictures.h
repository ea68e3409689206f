#pragma once

#include <filesystem>

#include "core/closure/structure_level.h"
#include "core/types/closure_result.h"

namespace tools {

// Pictures of a closed structural loop in the report's folder: structure_shapes.svg where shapes were measured,
// structure_place_N.svg of the N-th effect where it has places, structure_posterior.svg. Throws drivers::FileError.
void write_structure_pictures(const std::filesystem::path& folder, const core::closure::StructureLevel& level,
                              const core::closure::ClosureResult& result,
                              const core::structure::DeclaredFrame& declared);

}  // namespace tools
