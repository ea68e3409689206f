#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/simulation/scene.h"
#include "core/simulation/structure/beam_builders.h"
#include "core/simulation/structure/structure_builders.h"

namespace drivers {

// The operator's declaration of one property of the camera: the truth, nothing, or a wrong value.
struct Declared {
  enum class Kind : std::uint8_t { kTrue, kNothing, kValue };
  Kind kind = Kind::kTrue;
  double value = 0.0;

  [[nodiscard]] std::optional<double> of(double truth) const noexcept {
    if (kind == Kind::kNothing) return std::nullopt;
    return kind == Kind::kTrue ? truth : value;
  }
};

struct SceneDeclaration {
  Declared readout_ms, exposure_ms, rate_hz;
  bool lens = true, focal_length = true;  // time stamps: TimingParameters::stamps_tell
};

// A structure as described by the user. Which values apply depends on the type and the kind of damping.
struct SceneStructure {
  enum class Type : std::uint8_t { kUniformChain, kShearFrame, kCantilever, kBridgeDeck, kModes, kMatrices };
  enum class DampingKind : std::uint8_t { kModal, kRayleigh, kDashpots };
  using Rows = std::vector<std::vector<double>>;
  Type type = Type::kMatrices;
  core::simulation::StructureModel::Axis axis = core::simulation::StructureModel::Axis::kX;
  std::vector<double> frequency_hz;
  core::simulation::ShearBuilding frame;  // its masses also where modes are given
  core::simulation::Cantilever tower;     // its EI and mass per metre also of the deck
  core::simulation::BridgeDeck deck;      // its number of bodies also of the tower
  DampingKind damping_kind = DampingKind::kModal;
  core::simulation::ModalDamping modal_damping;
  core::simulation::RayleighDamping rayleigh;
  core::simulation::Dashpots dashpots;
  Rows shapes, tilts;  // modes: one row for each mode, one value for each body
  Rows mass, damping, stiffness, displacement, tilt;
  std::vector<double> influence;
};

// Plates made from the structure: one for the ground and one for each body, at their positions.
struct ScenePlates {
  double width_mm = 300.0, height_mm = 50.0, depth_mm = 2000.0;
  double spacing_mm = 0.0;  // 0 = from the structure's dimensions, or 140
  core::simulation::TextureParameters texture{0.0, 128.0, 25.0};
};

// A recorded flight that moves the camera instead of, or in addition to, the hover model.
struct SceneFlight {
  std::string file, imu;            // empty = none; relative to the scene file
  double from_s = 0.0, to_s = 0.0;  // of the log: the part that is used
  double imu_starts_at_s = 0.0;     // time of its first row in the flight
  double imu_from_s = 0.0;          // another time of the flight for the attitude; 0 = the same
  double scale = 1.0;
  double facing_deg = 0.0, gimbal_residual = 0.02, vibration_from_hz = 0.0;  // core::simulation::FlightUse
};

// One experiment: the scene, its description, and the operator's declarations.
struct SceneFile {
  core::simulation::Scene scene;
  std::string preset = "paper";
  SceneStructure structure;
  ScenePlates plates;
  SceneFlight flight;
  SceneDeclaration declare;
};

// Values of the command line that replace those of the file.
struct SceneOverrides {
  std::optional<std::string> preset;
  std::optional<std::uint64_t> seed;
  std::optional<double> duration_s;
  std::optional<int> width_px, height_px;  // both or none
};

[[nodiscard]] std::vector<std::string> scene_presets();

// Throw std::invalid_argument "FILE:LINE: section.key: VALUE is refused: allowed RANGE; remedy" on unknown, repeated
// and missing keys, wrong types and values out of range, and on a scene that core::simulation::validate refuses.
[[nodiscard]] SceneFile read_scene_file(const std::string& path, const SceneOverrides& overrides = {});
[[nodiscard]] SceneFile parse_scene(const std::string& text, const std::string& name,
                                    const SceneOverrides& overrides = {}, const std::string& folder = "");
[[nodiscard]] SceneFile preset_scene(const SceneOverrides& overrides = {});

// The complete scene: as a file that reads back to the same scene / as an object with the same keys.
[[nodiscard]] std::string scene_text(const SceneFile& file);
[[nodiscard]] nlohmann::ordered_json scene_json(const SceneFile& file);
// The value at a key or section of scene_json(): "camera.readout_ms". Null when there is none.
[[nodiscard]] nlohmann::ordered_json scene_value(const nlohmann::ordered_json& scene, const std::string& key);
// Every key with unit, default, range and meaning: the text of --help-scene.
[[nodiscard]] std::string scene_help();

}  // namespace drivers
