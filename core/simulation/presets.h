#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/simulation/scene.h"

namespace core::simulation {

// The experiment of the paper: six storeys at 1.657 ... 14.34 Hz, 1 % damping, a 1080p camera at 25 fps 2 m away.
[[nodiscard]] Scene make_paper_scene(std::uint64_t seed, double duration_s);

// The same view with another sensor: alpha and textures scale with the image so that the scene fits it alike.
void set_image_size(Scene& scene, int width_px, int height_px);

// Ground and floors one above the other, the ground lowest, the middle of the stack on the optical axis: plates of
// width x height, storey_mm from centre to centre, depth_mm away. Named base, floor1 .. floorN.
[[nodiscard]] std::vector<Plate> tower_plates(int n_floors, double width_mm, double height_mm, double storey_mm,
                                              double depth_mm);

}  // namespace core::simulation
