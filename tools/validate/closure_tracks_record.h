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
// What the operator declares is that of `declared`; the tracks are those of `scene`. Sigmas as the tracker states them.
[[nodiscard]] core::closure::ObservationRecord observation_record(const core::simulation::Scene& scene,
                                                                  const core::simulation::Scene& declared,
                                                                  bool background);

// What an effect changes in the tracks, beside their noise (rms over points, axes and frames).
struct EffectStrength {
  double plain = 0.0;     // change of the tracks, each point's about its mean over the record
  double constant = 0.0;  // the means: where a point stands, which no record of tracks tells apart from its place
  double visible = 0.0;   // in sigmas, what free motions of each region, of the structure's plane and of the background
                          // cannot hold; 0 = not asked for
};
// Of two records with the same noise. noise_px: rms over the points.
[[nodiscard]] EffectStrength strength_of(const core::closure::ObservationRecord& with,
                                         const core::closure::ObservationRecord& without, double noise_px,
                                         bool visible);
// rms over the record's points.
[[nodiscard]] double noise_px(const core::simulation::Scene& scene, bool background);

// core::simulation::validate() accepts it.
[[nodiscard]] bool holds_the_view(const core::simulation::Scene& scene);

// The scene with these effects: of these sizes, or each of this plain strength by itself; less where an effect's
// largest size, or a view that no longer holds the structure, ends it.
struct SizedScene {
  core::simulation::Scene scene;
  std::vector<double> size;  // of each effect
};
[[nodiscard]] SizedScene set_effects(const std::vector<const HiddenEffect*>& effects,
                                     const core::simulation::Scene& declared, std::vector<double> size);
[[nodiscard]] SizedScene with_effects(const std::vector<const HiddenEffect*>& effects,
                                      const core::simulation::Scene& declared, double strength, bool background);

}  // namespace tools
