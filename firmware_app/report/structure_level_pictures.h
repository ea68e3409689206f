#pragma once

#include <string>
#include <vector>

#include "core/closure/structure_level.h"
#include "core/types/closure_result.h"

namespace app {

struct StructurePicture {
  std::string name, title;  // name: of a file, without extension
  std::string svg;          // a complete file
};

// Pictures of a closed structural loop: structure_shapes where shapes were measured, structure_posterior where there
// are parameters, structure_drawing where something was found at a place of a structure with a geometry,
// structure_place_N of the N-th effect where it has places. Fits the places again: seconds. Any thread.
[[nodiscard]] std::vector<StructurePicture> structure_level_pictures(const core::closure::StructureLevel& level,
                                                                     const core::closure::ClosureResult& result,
                                                                     const core::structure::DeclaredFrame& declared);

}  // namespace app
