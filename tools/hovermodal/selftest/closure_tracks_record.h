#pragma once

#include <string>
#include <vector>

#include "core/closure/observation/observation_record.h"
#include "core/simulation/scene.h"

namespace tools {

// An effect that the operator does not declare. Strength = rms over points and frames of what the effect changes in
// the tracks beyond what a free motion of each region, of the structure's plane and of the background can hold, over
// the rms of the track noise.
struct HiddenEffect {
  std::string name;    // as core/closure calls it
  double most = 0.0;   // largest size that makes sense; 0 = any
  double start = 0.0;  // a small size, from which others are scaled
  void (*set)(core::simulation::Scene&, double size) = nullptr;
  // What parameters() should say first, of size and scene.
  double (*truth)(const core::simulation::Scene&, double size) = nullptr;
};
[[nodiscard]] const std::vector<HiddenEffect>& hidden_effects();

enum class Shaking { kGround, kWind };
struct RecordSetup {
  Shaking shaking = Shaking::kGround;
  bool background = true;
  double readout_frames = 0.7;
  double duration_s = 120.0;
};
[[nodiscard]] core::simulation::Scene closure_scene(const RecordSetup& setup, std::uint64_t seed);
// What the operator declares is that of `declared`; the tracks are those of `scene`.
[[nodiscard]] core::closure::ObservationRecord observation_record(const core::simulation::Scene& scene,
                                                                  const core::simulation::Scene& declared,
                                                                  bool background, bool noise = true);

// Size at which the effect has this strength, and what it then is as plain rms of the change in the tracks.
struct EffectSize {
  double size = 0.0, strength = 0.0, plain_strength = 0.0;
};
[[nodiscard]] EffectSize size_for(const HiddenEffect& effect, const RecordSetup& setup, double strength);

}  // namespace tools
