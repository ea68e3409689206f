#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "drivers/storage/scene/key.h"

namespace drivers {
namespace {

using core::simulation::Plate;
using core::simulation::Scene;
using core::simulation::StructureModel;
using Eigen::MatrixXd;
using Type = SceneStructure::Type;
using Rows = SceneStructure::Rows;

constexpr double kUsualSpacing_mm = 140.0;

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument("simulation: structure: " + what); }

MatrixXd matrix(const Rows& rows) {
  MatrixXd out(static_cast<Eigen::Index>(rows.size()), rows.empty() ? 0 : static_cast<Eigen::Index>(rows[0].size()));
  for (Eigen::Index i = 0; i < out.rows(); ++i) {
    for (Eigen::Index k = 0; k < out.cols(); ++k) {
      out(i, k) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
    }
  }
  return out;
}

core::simulation::Damping damping_of(const SceneStructure& s) {
  switch (s.damping_kind) {
    case SceneStructure::DampingKind::kRayleigh:
      return s.rayleigh;
    case SceneStructure::DampingKind::kDashpots:
      return s.dashpots;
    case SceneStructure::DampingKind::kModal:
      break;
  }
  return s.modal_damping;
}

// One ratio per frequency: the last applies to all higher ones.
std::vector<double> ratios_of(const SceneStructure& s) {
  std::vector<double> ratio = s.modal_damping.ratio;
  if (ratio.empty()) refuse("damping.ratio is empty; give one for each mode, or one for all");
  ratio.resize(s.frequency_hz.size(), ratio.back());
  return ratio;
}

StructureModel from_given_modes(const SceneStructure& s) {
  if (s.shapes.size() != s.frequency_hz.size() || s.shapes.empty()) {
    refuse(std::to_string(s.shapes.size()) + " shapes for " + std::to_string(s.frequency_hz.size()) +
           " frequencies; give one row for each");
  }
  const std::vector<double> mass =
      s.frame.mass_kg.empty() ? std::vector<double>(s.shapes[0].size(), 1.0) : s.frame.mass_kg;
  return core::simulation::from_modes(s.frequency_hz, ratios_of(s), matrix(s.shapes).transpose(), mass,
                                      matrix(s.tilts).transpose());
}

StructureModel from_given_matrices(const SceneStructure& s) {
  if (s.influence.empty() && s.displacement.empty()) {
    return core::simulation::from_matrices(matrix(s.mass), matrix(s.damping), matrix(s.stiffness));
  }
  StructureModel model;
  model.mass = matrix(s.mass);
  model.damping = matrix(s.damping);
  model.stiffness = matrix(s.stiffness);
  model.influence =
      Eigen::Map<const Eigen::VectorXd>(s.influence.data(), static_cast<Eigen::Index>(s.influence.size()));
  model.displacement = matrix(s.displacement);
  model.tilt = s.tilt.empty() ? MatrixXd::Zero(model.displacement.rows(), model.displacement.cols()) : matrix(s.tilt);
  return model;
}

core::simulation::BridgeDeck deck_of(const SceneStructure& s) {
  core::simulation::BridgeDeck deck = s.deck;
  deck.bending_stiffness_n_m2 = s.tower.bending_stiffness_n_m2;
  deck.mass_kg_per_m = s.tower.mass_kg_per_m;
  return deck;
}

StructureModel model_of(const SceneStructure& s) {
  core::simulation::Cantilever tower = s.tower;
  tower.bodies = s.deck.bodies;
  switch (s.type) {
    case Type::kUniformChain:
      return core::simulation::uniform_chain(s.frequency_hz, ratios_of(s));
    case Type::kShearFrame:
      return core::simulation::shear_frame(s.frame, damping_of(s));
    case Type::kCantilever:
      return core::simulation::cantilever(tower, damping_of(s));
    case Type::kBridgeDeck:
      return core::simulation::bridge_deck(deck_of(s), damping_of(s));
    case Type::kModes:
      return from_given_modes(s);
    case Type::kMatrices:
      break;
  }
  return from_given_matrices(s);
}

// Distance of body i (1 ..) from the ground, upward or along the deck.
double place_of(const SceneFile& file, int body) {
  const SceneStructure& s = file.structure;
  const int n = file.scene.structure.n_bodies();
  if (file.plates.spacing_mm > 0.0) return file.plates.spacing_mm * body;
  if (s.type == Type::kCantilever) return s.tower.height_mm * body / n;
  if (s.type == Type::kBridgeDeck) {
    return core::simulation::body_positions_mm(deck_of(s))[static_cast<std::size_t>(body) - 1];
  }
  if (s.type != Type::kShearFrame || s.frame.storey_height_mm.empty()) return kUsualSpacing_mm * body;
  double height = 0.0;
  for (int i = 0; i < body; ++i) height += s.frame.storey_height_mm[static_cast<std::size_t>(i)];
  return height;
}

}  // namespace

void build_structure(SceneFile& file) {
  file.scene.structure = model_of(file.structure);
  const bool turned = file.structure.type == Type::kModes || file.structure.type == Type::kMatrices;
  if (turned) file.scene.structure.axis = file.structure.axis;
}

// A tower stands on its ground; a deck has its abutment beside its left end.
void make_plates(SceneFile& file) {
  const ScenePlates& like = file.plates;
  const int n = file.scene.structure.n_bodies();
  const bool tower = file.scene.structure.axis == StructureModel::Axis::kX;
  const double middle_mm = 0.5 * (place_of(file, n) + (tower ? 0.0 : place_of(file, 1)));
  file.scene.plates.clear();
  for (int body = 0; body <= n; ++body) {
    const double ground_mm = tower ? 0.0 : -0.6 * like.width_mm;
    const double place_mm = (body == 0 ? ground_mm : place_of(file, body)) - middle_mm;
    Plate plate;
    plate.name = body == 0 ? "base" : (tower ? "floor" : "deck") + std::to_string(body);
    plate.x_mm = tower ? 0.0 : place_mm;
    plate.y_mm = tower ? -place_mm : 0.0;
    plate.z_mm = like.depth_mm;
    plate.width_mm = like.width_mm;
    plate.height_mm = like.height_mm;
    plate.texture = like.texture;
    file.scene.plates.push_back(plate);
  }
}

}  // namespace drivers
