// Drawn scenes as files for `hovermodal simulate`: clips with an undeclared effect.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "drivers/storage/scene/scene_file.h"
#include "tools/validate/closure_effects.h"
#include "tools/validate/closure_tracks.h"
#include "tools/validate/closure_tracks_record.h"
#include "tools/validate/closure_tracks_run.h"

namespace tools {
namespace {

using core::simulation::Scene;

constexpr double kDropProbability = 0.02;

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

// Lost frames are no effect in tracks with a sequence: the recorder's stamps do not tell of them.
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

void print_closure_clip(const ClosureTracksOptions& options) {
  const Scene declared = closure_scene(setup_for(options), seed_of(options, 1));
  drivers::SceneFile file;
  file.scene = with_these(names_in(options.effect), declared);
  file.structure.mass = rows_of(declared.structure.mass);
  file.structure.damping = rows_of(declared.structure.damping);
  file.structure.stiffness = rows_of(declared.structure.stiffness);
  file.declare.readout_ms = {drivers::Declared::Kind::kValue, 1e3 * declared.camera.readout_s};
  file.declare.lens = false;  // the declared camera has none
  fmt::print("{}", drivers::scene_text(file));
}

}  // namespace tools
