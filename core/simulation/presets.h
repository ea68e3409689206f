#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "core/simulation/scene.h"
#include "core/simulation/structure/beam_builders.h"
#include "core/simulation/structure/structure_builders.h"

namespace core::simulation {

// The experiment of the paper: six storeys at 1.657 ... 14.34 Hz, 1 % damping, a 1080p camera at 25 fps 2 m away.
[[nodiscard]] Scene make_paper_scene(std::uint64_t seed, double duration_s);

// A slender steel chimney of 30 m in the wind, eight marked sections, from 40 m at 30 fps: sways at 0.77, 4.9 and 13.6
// Hz, and its sections tilt. 1 px = 31 mm.
[[nodiscard]] Scene make_cantilever_scene(std::uint64_t seed, double duration_s);

// A frame of four unequal storeys on a shaking table, with forces on its floors, from 2.5 m at 25 fps: 2.3 ... 10.9 Hz.
[[nodiscard]] Scene make_shear_frame_scene(std::uint64_t seed, double duration_s);

// A footbridge of 40 m under walkers, seven marked places and a static abutment, from 45 m at 50 fps: vertical
// modes at 1.9, 7.6 and 17.1 Hz. 1 px = 25 mm. All bodies lie in the same rows, so a downward readout is not
// informative.
[[nodiscard]] Scene make_deck_scene(std::uint64_t seed, double duration_s);

// Parameters of the structure of a preset.
struct UniformChain {
  std::vector<double> frequency_hz;
};
struct StructureDescription {
  std::variant<UniformChain, ShearBuilding, Cantilever, BridgeDeck> kind;
  ModalDamping damping;  // the last ratio applies to all modes above
};
[[nodiscard]] StructureModel build(const StructureDescription& description);

// By name, for a command line.
struct PresetInfo {
  std::string name, description;
  StructureDescription (*structure)();
  Scene (*make)(std::uint64_t seed, double duration_s);
};
[[nodiscard]] const std::vector<PresetInfo>& presets();
// Throws std::invalid_argument with the list of names.
[[nodiscard]] Scene make_preset(const std::string& name, std::uint64_t seed, double duration_s);

// Sets the pitch of textures without one (0 or less) according to their distance: plates 2.75 px per cell, with content
// up to 0.2 cycles/px, the background 7 px.
void settle_textures(Scene& scene);

// The same view with another sensor: focal length and principal point scale with the image so that the scene fits it
// equally, and textures keep their pitch in pixels.
void set_image_size(Scene& scene, int width_px, int height_px);

// Ground and floors one above the other, the ground lowest, the middle of the stack on the optical axis: plates of
// width x height, storey_mm from centre to centre, depth_mm away. Named base, floor1 .. floorN.
[[nodiscard]] std::vector<Plate> tower_plates(int n_floors, double width_mm, double height_mm, double storey_mm,
                                              double depth_mm);

}  // namespace core::simulation
