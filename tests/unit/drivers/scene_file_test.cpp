#include "drivers/storage/scene/scene_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>
#include <string>

namespace drivers {
namespace {

using testing::HasSubstr;

SceneFile parse(const std::string& text, const SceneOverrides& overrides = {}) {
  return parse_scene(text, "scene.yaml", overrides);
}

std::string refusal(const std::string& text) {
  try {
    (void)parse(text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "taken";
}

TEST(SceneFile, ChangesOneThingOfThePreset) {
  const SceneFile file = parse("camera: {readout_ms: 12.5, attitude_deg: [0.2, 0, 0]}\nduration_s: 7\n");
  EXPECT_EQ(file.preset, "paper");
  EXPECT_DOUBLE_EQ(file.scene.camera.readout_s, 0.0125);
  EXPECT_DOUBLE_EQ(file.scene.camera.pitch_rad, 0.2 * std::numbers::pi / 180.0);
  EXPECT_DOUBLE_EQ(file.scene.duration_s, 7.0);
  EXPECT_DOUBLE_EQ(file.scene.camera.exposure_s, 0.004);
  EXPECT_EQ(file.scene.plates.size(), 7U);
}

TEST(SceneFile, EveryPresetIsWrittenAndReadBackToTheSameScene) {
  for (const std::string& preset : scene_presets()) {
    SceneOverrides overrides;
    overrides.preset = preset;
    const SceneFile file = preset_scene(overrides);
    const std::string text = scene_text(file);
    const SceneFile again = parse(text);
    EXPECT_EQ(scene_text(again), text) << preset;
    EXPECT_EQ(scene_json(again), scene_json(file)) << preset;
    EXPECT_EQ(again.scene.structure.stiffness, file.scene.structure.stiffness) << preset;
    EXPECT_EQ(again.scene.structure.damping, file.scene.structure.damping) << preset;
    // Written as its description, because matrices would be unreadable.
    EXPECT_NE(file.structure.type, SceneStructure::Type::kMatrices) << preset;
  }
}

TEST(SceneFile, ReadsTheEffectsOfRealRecordsInTheirUnits) {
  const std::string text =
      "tailed_hover: {rms_mm: [20, 1, 15], order: [3, 4, 5], rms_deg: [0, 0, 0.09]}\n"
      "vibration: {rms_mdeg: [1, 2, 18]}\nstabiliser: {gain: 0.7, lag_ms: 40}\nbreathing: {rms: 0.001, centre_px: [90, "
      "-20]}\n"
      "shimmer: {rms_px: 0.3, drift_px_s: [5, -6]}\nflap: {rms_mm: 2, body: 3}\nrocking: {rms_deg: 0.18}\n"
      "torsion: {rms_deg: 1.8, frequency_hz: 2.5}\nsway: {rms_mm: 4}\ntracks: {template_zoom_px: 1.2}\n";
  const SceneFile file = parse(text);
  const auto& scene = file.scene;
  constexpr double kDegree = 180.0 / std::numbers::pi;
  EXPECT_EQ(scene.tailed_hover.rms_mm, (std::array<double, 3>{20.0, 1.0, 15.0}));
  EXPECT_EQ(scene.tailed_hover.order, (std::array<double, 3>{3.0, 4.0, 5.0}));
  EXPECT_DOUBLE_EQ(scene.tailed_hover.rms_rad[2], 0.09 / kDegree);
  EXPECT_DOUBLE_EQ(scene.vibration.rms_rad[2], 0.018 / kDegree);
  EXPECT_DOUBLE_EQ(scene.stabiliser.lag_s, 0.04);
  EXPECT_EQ(scene.breathing.centre_px[1], -20.0);
  EXPECT_EQ(scene.shimmer.drift_px_s[1], -6.0);
  EXPECT_EQ(scene.flap.body, 3);
  EXPECT_DOUBLE_EQ(scene.rocking.rms_rad, 0.18 / kDegree);
  EXPECT_DOUBLE_EQ(scene.torsion.rms_rad, 1.8 / kDegree);
  EXPECT_EQ(scene.torsion.frequency_hz, 2.5);
  EXPECT_EQ(scene.sway.rms_mm, 4.0);
  EXPECT_EQ(scene.tracks.template_zoom_px, 1.2);
  EXPECT_EQ(scene_json(parse(scene_text(file))), scene_json(file));
}

TEST(SceneFile, TheCommandLineWins) {
  SceneOverrides overrides;
  overrides.seed = 9;
  overrides.duration_s = 3.0;
  overrides.width_px = 960;
  overrides.height_px = 540;
  const SceneFile file = parse("seed: 4\nduration_s: 8\ncamera: {alpha_px: 2000}\n", overrides);
  EXPECT_EQ(file.scene.seed, 9U);
  EXPECT_DOUBLE_EQ(file.scene.duration_s, 3.0);
  EXPECT_EQ(file.scene.camera.width_px, 960);
  EXPECT_DOUBLE_EQ(file.scene.camera.alpha_px, 1000.0);
}

TEST(SceneFile, MakesPlatesWhereTheBodiesAre) {
  const SceneFile frame = parse(
      "structure: {type: shear_frame, mass_kg: [10, 8], stiffness_n_per_m: [9000, 8000], storey_height_mm: [150, "
      "250]}\n");
  ASSERT_EQ(frame.scene.plates.size(), 3U);
  EXPECT_DOUBLE_EQ(frame.scene.plates[0].y_mm - frame.scene.plates[1].y_mm, 150.0);
  EXPECT_DOUBLE_EQ(frame.scene.plates[1].y_mm - frame.scene.plates[2].y_mm, 250.0);
  const SceneFile deck = parse("preset: deck\nplates: {width_mm: 1000, height_mm: 800, depth_mm: 45000}\n");
  ASSERT_EQ(deck.scene.plates.size(), 8U);
  EXPECT_DOUBLE_EQ(deck.scene.plates[2].x_mm - deck.scene.plates[1].x_mm, 5000.0);
  EXPECT_NEAR(deck.scene.plates[1].texture.pitch_mm, 2.75 * 45000.0 / deck.scene.camera.alpha_px, 1e-9);
}

TEST(SceneFile, BuildsStructuresFromModesAndMatrices) {
  const SceneFile modes = parse(
      "structure: {type: modes, frequency_hz: [2, 5], damping: {ratio: [0.02]}, shapes: [[0.5, 1], [1, -0.6]], "
      "mass_kg: [3, 2]}\n");
  const auto found = core::simulation::modes_of(modes.scene.structure);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[1].frequency_hz, 5.0, 1e-9);
  EXPECT_NEAR(found[1].damping_ratio, 0.02, 1e-9);
  EXPECT_NEAR(std::abs(found[0].displacement(0)), 0.5, 1e-9);
  const SceneFile matrices =
      parse("structure: {type: matrices, mass_matrix: [[2]], damping_matrix: [[1]], stiffness_matrix: [[800]]}\n");
  EXPECT_NEAR(core::simulation::modes_of(matrices.scene.structure).at(0).frequency_hz, 20.0 / (2.0 * std::numbers::pi),
              1e-9);
  EXPECT_EQ(scene_text(parse(scene_text(matrices))), scene_text(matrices));
}

TEST(SceneFile, ReadsListsOfPeaksAndHarmonics) {
  const SceneFile file = parse(
      "excitation:\n  base_peaks:\n    - {frequency_hz: 3, gain: 2}\n  harmonics:\n"
      "    - {body: 2, frequency_hz: 4.5, rms_mm: 0.5}\n    - {frequency_hz: 7, rms_mm: 0.1}\n");
  ASSERT_EQ(file.scene.excitation.base_peaks.size(), 1U);
  EXPECT_DOUBLE_EQ(file.scene.excitation.base_peaks[0].gain, 2.0);
  ASSERT_EQ(file.scene.excitation.harmonics.size(), 2U);
  EXPECT_EQ(file.scene.excitation.harmonics[0].body, 2);
}

TEST(SceneFile, KeepsWhatIsDeclared) {
  const SceneFile file = parse("declare: {readout_ms: 15, exposure_ms: false, timestamps: false, lens: false}\n");
  EXPECT_EQ(file.declare.readout_ms.of(26.0), 15.0);
  EXPECT_EQ(file.declare.exposure_ms.of(4.0), std::nullopt);
  EXPECT_EQ(file.declare.rate_hz.of(25.0), 25.0);
  EXPECT_FALSE(file.scene.timing.stamps_tell);
  EXPECT_FALSE(file.declare.lens);
  EXPECT_TRUE(file.declare.focal_length);
}

TEST(SceneFile, FindsValuesByKey) {
  const auto scene = scene_json(parse("camera: {exposure_ms: 3}\n"));
  EXPECT_EQ(scene_value(scene, "camera.exposure_ms"), 3.0);
  EXPECT_TRUE(scene_value(scene, "rotor").is_object());
  EXPECT_TRUE(scene_value(scene, "camera.nothing").is_null());
}

TEST(SceneFile, HelpTellsEveryKeyWithDefaultAndRange) {
  const std::string help = scene_help();
  EXPECT_THAT(help, HasSubstr("camera.readout_ms                    number, ms\n"));
  EXPECT_THAT(help, HasSubstr("default: 26   allowed: 0 .. 1000\n"));
  EXPECT_THAT(help, HasSubstr("declare.timestamps"));
}

TEST(SceneFile, RefusesNamingFileLineKeyValueAndRange) {
  EXPECT_THAT(refusal("seed: 1\ncamera:\n  rate_hzz: 3\n"),
              HasSubstr("scene.yaml:3: camera.rate_hzz: unknown key; did you mean `camera.rate_hz`?"));
  EXPECT_THAT(refusal("camera:\n  rate_hz: nan\n"), HasSubstr("scene.yaml:2: camera.rate_hz: nan is refused"));
  EXPECT_THAT(refusal("camera:\n  rate_hz: fast\n"), HasSubstr("allowed 1 .. 10000 (Hz)"));
  EXPECT_THAT(refusal("seed: 1\nseed: 2\n"), HasSubstr("scene.yaml:2: key `seed` is written twice"));
  EXPECT_THAT(refusal("hover: {x_rms_mm: -1}\n"), HasSubstr("-1 is refused: allowed 0 .. 100000 (mm)"));
  EXPECT_THAT(refusal("preset: other\n"), HasSubstr("paper | cantilever | shear_frame | deck"));
  EXPECT_THAT(refusal("tracks: {points_per_region: 2.5}\n"), HasSubstr("whole number"));
  EXPECT_THAT(refusal("camera: 3\n"), HasSubstr("a section"));
  EXPECT_THAT(refusal("plates:\n  - {name: a}\n  - {name: a}\n"), HasSubstr("scene.yaml:3: plates.1.name"));
  EXPECT_THAT(refusal("structure: {mass_kg: [1]}\n"), HasSubstr("has no meaning for this type"));
  EXPECT_THAT(refusal("declare: {readout_ms: perhaps}\n"), HasSubstr("true | false | -1000 .. 1000"));
  EXPECT_THAT(refusal(""), HasSubstr("scene.yaml"));
  EXPECT_THAT(refusal("- a\n"), HasSubstr("scene.yaml:1: the file"));
}

TEST(SceneFile, NamesTheSectionOfASceneThatCannotBe) {
  EXPECT_THAT(refusal("seed: 1\nstructure: {damping: {ratio: [-0.01]}}\n"),
              HasSubstr("scene.yaml:2: structure: damping ratio is -0.01"));
  EXPECT_THAT(refusal("structure: {type: shear_frame, mass_kg: [1, 1], stiffness_n_per_m: [1, -5]}\n"),
              HasSubstr("scene.yaml:1: structure: "));
  EXPECT_THAT(refusal("structure: {type: matrices, mass_matrix: [[1]], damping_matrix: [[0.1]], "
                      "stiffness_matrix: [[-3]]}\n"),
              HasSubstr("unstable"));
  EXPECT_THAT(refusal("camera: {position_mm: [0, 0, 1990]}\n"), HasSubstr("scene.yaml:1: camera: distance"));
  EXPECT_THAT(refusal("plates: {texture: {contrast_rms: 0}}\n"), HasSubstr("scene.yaml:1: plates: texture contrast"));
  EXPECT_THAT(refusal("seed: 2\nhover: {corner_hz: 50}\n"), HasSubstr("scene.yaml:2: hover: "));
  EXPECT_THAT(refusal("flight: {file: missing.csv, to_s: 10}\n"), HasSubstr("scene.yaml:1: flight: missing.csv"));
  EXPECT_THAT(refusal("flight: {file: missing.csv}\n"), HasSubstr("to_s does not lie after from_s"));
}

TEST(SceneFile, ReadsAFlightBesideTheSceneFile) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "hovermodal_scene_flight";
  std::filesystem::create_directories(folder);
  {
    std::ofstream log(folder / "log.csv");
    log.precision(12);
    log << "time(millisecond),latitude,longitude,altitude(m),compass_heading(degrees)\n";
    for (int i = 0; i < 200; ++i) log << 100 * i << ",40.0," << -88.0 + 1e-7 * std::sin(0.3 * i) << ",50,90\n";
    std::ofstream(folder / "scene.yaml") << "flight: {file: log.csv, from_s: 1, to_s: 15, scale: 0.5}\n";
  }
  const SceneFile file = read_scene_file((folder / "scene.yaml").string());
  ASSERT_NE(file.scene.flight, nullptr);
  EXPECT_NEAR(file.scene.flight->rate_hz, 10.0, 1e-9);
  double largest = 0.0;
  for (const double x : file.scene.flight->x_mm) largest = std::max(largest, std::abs(x));
  EXPECT_NEAR(largest, 0.5 * 8.5, 0.7);  // 1e-7 degrees of longitude at 40 degrees north: 8.5 mm
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace drivers
