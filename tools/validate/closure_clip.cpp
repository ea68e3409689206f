// Drawn scenes as files for `hovermodal simulate`: clips with an undeclared effect.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "drivers/storage/flight_log.h"
#include "drivers/storage/scene/scene_file.h"
#include "tools/validate/closure_effects.h"
#include "tools/validate/closure_tracks.h"
#include "tools/validate/closure_tracks_record.h"
#include "tools/validate/closure_tracks_run.h"
#include "tools/validate/drawn_scene.h"
#include "tools/validate/foreign_effects.h"
#include "tools/validate/foreign_scene.h"
#include "tools/validate/recorded_hover.h"

namespace tools {
namespace {

using core::simulation::Scene;

constexpr double kDropProbability = 0.02;
constexpr double kClipNoise_px = 0.09;  // of a 1080p view: 0.03 px for a tracker in pictures of a third of that size
constexpr double kTallerPlates = 1.9;   // two thirds of a storey: small pictures have few rows

drivers::SceneStructure::Rows rows_of(const Eigen::MatrixXd& matrix) {
  drivers::SceneStructure::Rows rows;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    rows.emplace_back();
    for (Eigen::Index k = 0; k < matrix.cols(); ++k) rows.back().push_back(matrix(i, k));
  }
  return rows;
}

// "a + b" -> {a, b}
std::vector<std::string> names_in(const std::string& text) {
  std::vector<std::string> names;
  const std::string between = " + ";
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t to = std::min(text.find(between, from), text.size());
    names.push_back(text.substr(from, to - from));
    from = to + between.size();
  }
  return names;
}

// In tracks with a sequence, lost frames are no effect to find: only the recorder's stamps must not show them.
bool lose_frames(std::vector<std::string>& names, Scene& scene) {
  if (std::erase(names, "dropped frames") == 0) return false;
  scene.timing.drop_probability = kDropProbability;
  scene.timing.stamps_tell = false;
  return true;
}

Scene with_these(std::vector<std::string> names, const Scene& declared) {
  static const std::map<std::string, double> sizes{
      {"readout time", 0.5}, {"radial distortion", 0.18}, {"tangential distortion", 0.02}};
  Scene base = declared;
  (void)lose_frames(names, base);
  std::vector<const HiddenEffect*> effects;
  std::vector<double> size;
  for (const std::string& name : names) {
    if (!sizes.contains(name)) throw std::invalid_argument("no clip is drawn with the effect " + name);
    effects.push_back(&effect_named(name));
    size.push_back(sizes.at(name));
  }
  return set_effects(effects, base, size).scene;
}

}  // namespace

namespace {

// A record longer than the recorded hover plays it back and forth.
double drawn_start_s(std::uint64_t seed, double duration_s) {
  return kHoverFrom_s +
         std::max(0.0, kHoverTo_s - kHoverFrom_s - duration_s) * Draw(seed, "clip_flight").uniform(0.0, 1.0);
}

// Comment lines from which a figure script reads the truth.
void print_truth(const ForeignEffect& effect, const Scene& scene, const Scene& declared) {
  for (const std::string& name : effect.names) fmt::print("# name\t{}\n", name);
  for (const KnownValue& known : effect.effect.truth(scene, declared))
    fmt::print("# truth\t{}\t{:.9g}\n", known.name, known.value);
}

void print_scene(drivers::SceneFile file, const Scene& declared) {
  file.structure.mass = rows_of(declared.structure.mass);
  file.structure.damping = rows_of(declared.structure.damping);
  file.structure.stiffness = rows_of(declared.structure.stiffness);
  file.declare.readout_ms = {drivers::Declared::Kind::kValue, 1e3 * declared.camera.readout_s};
  file.declare.lens = false;  // the declared camera has no lens model
  fmt::print("{}", drivers::scene_text(file));
}

}  // namespace

void print_closure_clip(const ClosureTracksOptions& options) {
  const Scene declared = closure_scene(setup_for(options), seed_of(options, 1));
  drivers::SceneFile file;
  file.scene = with_these(names_in(options.effect), declared);
  print_scene(file, declared);
}

void print_closure_clip_foreign(const ClosureTracksOptions& options) {
  const std::uint64_t seed = seed_of(options, 1);
  ForeignScene foreign = draw_foreign_scene(seed, setup_for(options).duration_s, options.flight);
  for (auto& plate : foreign.scene.plates) plate.height_mm *= kTallerPlates;
  while (!holds_the_view(foreign.scene)) {
    for (auto& plate : foreign.scene.plates) plate.height_mm *= 0.95;
  }
  foreign.scene.tracks.noise_px = kClipNoise_px;  // the unit of strength
  drivers::SceneFile file;
  file.scene = foreign.scene;
  if (!options.effect.empty()) {
    const ForeignEffect& effect = foreign_effect_named(options.effect);
    const double strength = options.strength > 0.0 ? options.strength : 1.0;
    file.scene = with_effects({&effect.effect}, foreign.scene, strength, foreign.background).scene;
    print_truth(effect, file.scene, foreign.scene);
  }
  if (foreign.scene.flight != nullptr) {
    file.flight.file = std::filesystem::absolute(options.flight).string();
    file.flight.to_s = kHoverTo_s;
    file.flight.from_s = drawn_start_s(seed, setup_for(options).duration_s);
    file.flight.facing_deg = drivers::read_flight_path(options.flight, kHoverFrom_s, kHoverTo_s).mean_heading_deg;
    file.flight.gimbal_residual = 0.0;
    file.flight.scale = foreign.flight_scale;
  }
  fmt::print("# {}\n", foreign.words);
  print_scene(file, foreign.scene);
}

}  // namespace tools
