#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/closure/observation/observation_record.h"
#include "core/simulation/scene.h"
#include "tools/validate/closure_effects.h"

namespace tools {

enum class Shaking : std::uint8_t { kGround, kWind };
struct RecordSetup {
  Shaking shaking = Shaking::kGround;
  bool background = true;
  std::optional<double> readout_frames = {};  // empty: as drawn
  double duration_s = 120.0;
};
// Camera, structure and noise of the seed (drawn_scene.h), ten points a region.
[[nodiscard]] core::simulation::Scene closure_scene(const RecordSetup& setup, std::uint64_t seed);
// Declared as in `declared`, with the tracks of `scene`. Sigmas as the tracker states them.
[[nodiscard]] core::closure::ObservationRecord observation_record(const core::simulation::Scene& scene,
                                                                  const core::simulation::Scene& declared,
                                                                  bool background);

// The change of the tracks by an effect, without their noise (rms over points, axes and frames).
struct EffectStrength {
  double plain = 0.0;     // change of the tracks, each point about its mean over the record
  double constant = 0.0;  // change of the means: not observable in tracks, because it equals another reference position
  double visible = 0.0;   // in sigmas, the part that free motions of each region, of the structure's plane and of the
                          // background cannot explain; 0 = not requested
};
// From two records with the same noise. noise_px: rms over the points.
[[nodiscard]] EffectStrength strength_of(const core::closure::ObservationRecord& with,
                                         const core::closure::ObservationRecord& without, double noise_px,
                                         bool visible);
// rms over the record's points.
[[nodiscard]] double noise_px(const core::simulation::Scene& scene, bool background);

// Whether core::simulation::validate() accepts it.
[[nodiscard]] bool holds_the_view(const core::simulation::Scene& scene);

// The scene with these effects: of these sizes, or each with this plain strength by itself; smaller where an effect's
// largest size is reached, or the structure would leave the view.
struct SizedScene {
  core::simulation::Scene scene;
  std::vector<double> size;  // of each effect
};
[[nodiscard]] SizedScene set_effects(const std::vector<const HiddenEffect*>& effects,
                                     const core::simulation::Scene& declared, std::vector<double> size);
[[nodiscard]] SizedScene with_effects(const std::vector<const HiddenEffect*>& effects,
                                      const core::simulation::Scene& declared, double strength, bool background);

}  // namespace tools
