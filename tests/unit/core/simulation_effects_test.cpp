#include "core/simulation/effects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "core/simulation/presets.h"

namespace core::simulation {
namespace {

// Every effect at once.
Scene troubled_scene() {
  Scene scene = make_paper_scene(3, 10.0);
  scene.camera.lens = {LensParameters::Model::kRadialTangential, {-0.05, 0.02, 0.001, 0.001, 0.0}};
  scene.camera.pitch_rad = 0.01;
  scene.hover.pitch_rms_rad = scene.hover.yaw_rms_rad = scene.hover.roll_rms_rad = 1e-4;
  scene.hover.zoom_rms = 1e-4;
  scene.tailed_hover.rms_mm = {0.5, 0.0, 0.0};
  scene.tailed_hover.rms_rad = {0.0, 0.0, 1e-4};
  scene.vibration.rms_rad = {1e-5, 0.0, 0.0};
  scene.stabiliser.gain = 0.5;
  scene.breathing.rms = 1e-4;
  scene.shimmer.rms_px = 0.05;
  scene.flap.rms_mm = 0.1;
  scene.rocking.rms_rad = scene.torsion.rms_rad = 1e-4;
  scene.sway.rms_mm = 0.2;
  scene.tracks.template_zoom_px = 0.1;
  scene.flight = std::make_shared<const RecordedMotion>();
  scene.rotor.roll_rms_rad = 1e-5;
  scene.timing.jitter_rms_s = 1e-3;
  scene.timing.drop_probability = scene.timing.duplicate_probability = 0.01;
  scene.light.gain_rms = scene.light.flicker_depth = 0.05;
  scene.tracks.pixel_locking_px = scene.tracks.brightness_bias_px = 0.01;
  scene.tracks.loss_probability = scene.channels.loss_probability = 0.01;
  scene.excitation.base_peaks.push_back({6.0, 0.05, 2.0});
  scene.excitation.harmonics.push_back({2, 3.3, 0.5});
  scene.change.frequency_drift = scene.change.softening = 0.02;
  return scene;
}

TEST(Effects, AllAreActiveInASceneThatHasAll) { EXPECT_EQ(active_effects(troubled_scene()), effect_names()); }

TEST(Effects, TakingOneAwayLeavesEveryOther) {
  const Scene scene = troubled_scene();
  for (const std::string& name : effect_names()) {
    std::vector<std::string> others = effect_names();
    std::erase(others, name);
    EXPECT_EQ(active_effects(without_effect(scene, name)), others) << name;
  }
}

TEST(Effects, HaveNamesOfTheirOwnAndSayTheirParameters) {
  const std::vector<std::string> names = effect_names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  for (const std::string& name : names) EXPECT_FALSE(effect_keys(name).empty()) << name;
}

TEST(Effects, AreNotThereInAStillIdealCamera) {
  Scene scene = troubled_scene();
  for (const std::string& name : effect_names()) scene = without_effect(scene, name);
  EXPECT_TRUE(active_effects(scene).empty());
  validate(scene);
}

TEST(Effects, RefuseAnUnknownName) {
  EXPECT_THROW((void)without_effect(troubled_scene(), "gremlins"), std::invalid_argument);
  EXPECT_THROW((void)effect_keys(""), std::invalid_argument);
}

}  // namespace
}  // namespace core::simulation
