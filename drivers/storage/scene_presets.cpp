#include <Eigen/Core>
#include <map>

#include "core/simulation/presets.h"
#include "drivers/storage/scene_key.h"

namespace drivers {
namespace {

using Type = SceneStructure::Type;

SceneStructure paper() {
  SceneStructure out;
  out.type = Type::kUniformChain;
  out.frequency_hz = {1.657, 5.04, 8.14, 10.83, 12.93, 14.34};
  out.modal_damping.ratio = {0.01};
  return out;
}

SceneStructure cantilever() {
  SceneStructure out;
  out.type = Type::kCantilever;
  out.tower = {30.0e3, 1, 2.8e8, 170.0, 80.0};
  out.deck.bodies = 8;
  out.modal_damping.ratio = {0.008, 0.010, 0.012};
  return out;
}

SceneStructure shear_frame() {
  SceneStructure out;
  out.type = Type::kShearFrame;
  out.frame.mass_kg = {12.0, 11.0, 11.0, 8.0};
  out.frame.stiffness_n_per_m = {1.9e4, 1.6e4, 1.4e4, 1.2e4};
  out.modal_damping.ratio = {0.010, 0.008, 0.012, 0.015};
  return out;
}

SceneStructure deck() {
  SceneStructure out;
  out.type = Type::kBridgeDeck;
  out.axis = core::simulation::StructureModel::Axis::kY;
  out.deck.span_mm = 40.0e3;
  out.deck.bodies = 7;
  out.tower.bending_stiffness_n_m2 = 4.494e9;
  out.tower.mass_kg_per_m = 1200.0;
  out.modal_damping.ratio = {0.006, 0.008, 0.010};
  return out;
}

SceneStructure::Rows rows_of(const Eigen::MatrixXd& matrix) {
  SceneStructure::Rows rows(static_cast<std::size_t>(matrix.rows()));
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index k = 0; k < matrix.cols(); ++k) rows[static_cast<std::size_t>(i)].push_back(matrix(i, k));
  }
  return rows;
}

SceneStructure by_matrices(const core::simulation::StructureModel& model) {
  SceneStructure out;
  out.axis = model.axis;
  out.mass = rows_of(model.mass);
  out.damping = rows_of(model.damping);
  out.stiffness = rows_of(model.stiffness);
  out.displacement = rows_of(model.displacement);
  if (model.tilt.cwiseAbs().maxCoeff() > 0.0) out.tilt = rows_of(model.tilt);
  out.influence.assign(model.influence.data(), model.influence.data() + model.influence.size());
  return out;
}

bool same(const core::simulation::StructureModel& a, const core::simulation::StructureModel& b) {
  return a.n_bodies() == b.n_bodies() && a.n_coordinates() == b.n_coordinates() && a.axis == b.axis &&
         a.mass == b.mass && a.damping == b.damping && a.stiffness == b.stiffness;
}

}  // namespace

std::vector<std::string> scene_presets() {
  std::vector<std::string> names;
  for (const auto& preset : core::simulation::presets()) names.push_back(preset.name);
  return names;
}

// A preset's scene holds matrices only. Its structure is described by what it was built from where that is known here
// and gives the same matrices; else by the matrices.
void start_from_preset(SceneFile& file, const std::string& name) {
  static const std::map<std::string, SceneStructure (*)()> kDescriptions{
      {"paper", paper}, {"cantilever", cantilever}, {"shear_frame", shear_frame}, {"deck", deck}};
  file.preset = name;
  file.scene = core::simulation::make_preset(name, file.scene.seed, file.scene.duration_s);
  const core::simulation::StructureModel made = file.scene.structure;
  if (const auto known = kDescriptions.find(name); known != kDescriptions.end()) {
    file.structure = known->second();
    build_structure(file);
    if (same(file.scene.structure, made)) return;
  }
  file.scene.structure = made;
  file.structure = by_matrices(made);
}

}  // namespace drivers
