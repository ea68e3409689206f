#pragma once

#include <string>

#include "core/simulation/renderer.h"

namespace tools {

// Draws every frame of the scene on `n_threads` threads and encodes them in order. Throws std::runtime_error when the
// encoder fails; the file then does not exist.
void write_clip(const core::simulation::Renderer& renderer, const std::string& path, int crf, int n_threads);

}  // namespace tools
