#pragma once

#include <vector>

#include "core/simulation/render/texture.h"
#include "core/simulation/scene.h"

namespace core::simulation {

// Textures of the scene. Both throw std::invalid_argument for a texture that is finer than 1.5 px in the image
// (sampling at pixel centres would alias) or too large for memory.
[[nodiscard]] Texture background_texture(const Scene& scene);  // repeats beyond the view of a camera that looks along Z
[[nodiscard]] std::vector<Texture> plate_textures(const Scene& scene);  // by body

}  // namespace core::simulation
