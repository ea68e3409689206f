#include "core/simulation/structure/beam_builders.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>

#include "core/simulation/structure/structure_check.h"

namespace core::simulation {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr int kFewestElements = 24, kMostElements = 60;

// Free-free beam: node n has deflection 2 n and slope 2 n + 1.
struct Beam {
  MatrixXd mass, stiffness;
  std::vector<bool> held;  // by coordinate

  Beam(int n_elements, double length_m, double bending_stiffness, double mass_per_m)
      : mass(MatrixXd::Zero(2 * n_elements + 2, 2 * n_elements + 2)),
        stiffness(mass),
        held(static_cast<std::size_t>(mass.rows()), false) {
    const double l = length_m / n_elements;
    Eigen::Matrix4d k, m;
    k << 12, 6 * l, -12, 6 * l, 6 * l, 4 * l * l, -6 * l, 2 * l * l, -12, -6 * l, 12, -6 * l, 6 * l, 2 * l * l, -6 * l,
        4 * l * l;
    m << 156, 22 * l, 54, -13 * l, 22 * l, 4 * l * l, 13 * l, -3 * l * l, 54, 13 * l, 156, -22 * l, -13 * l, -3 * l * l,
        -22 * l, 4 * l * l;
    for (Index e = 0; e < n_elements; ++e) {
      stiffness.block<4, 4>(2 * e, 2 * e) += bending_stiffness / (l * l * l) * k;
      mass.block<4, 4>(2 * e, 2 * e) += mass_per_m * l / 420.0 * m;
    }
  }
  void hold(int coordinate) { held[static_cast<std::size_t>(coordinate)] = true; }
};

// The free coordinates of the beam, with bodies at the nodes given.
StructureModel assemble(const Beam& beam, const std::vector<int>& body_node, StructureModel::Axis axis) {
  std::vector<Index> free;
  for (std::size_t c = 0; c < beam.held.size(); ++c) {
    if (!beam.held[c]) free.push_back(static_cast<Index>(c));
  }
  const auto n = static_cast<Index>(free.size()), bodies = static_cast<Index>(body_node.size());
  StructureModel model;
  model.axis = axis;
  model.mass = beam.mass(free, free);
  model.stiffness = beam.stiffness(free, free);
  model.displacement = model.tilt = MatrixXd::Zero(bodies, n);
  // The ground moves the held nodes, too: the inertial coupling of their elements to the free nodes is included.
  Eigen::VectorXd rigid = Eigen::VectorXd::Zero(beam.mass.rows());
  for (Index c = 0; c < rigid.size(); c += 2) rigid(c) = 1.0;
  model.influence = (beam.mass * rigid)(free);
  for (Index i = 0; i < bodies; ++i) {
    for (Index c = 0; c < n; ++c) {
      const Index own = 2 * body_node[static_cast<std::size_t>(i)];
      if (free[static_cast<std::size_t>(c)] == own) model.displacement(i, c) = 1.0;
      if (free[static_cast<std::size_t>(c)] == own + 1) model.tilt(i, c) = 1e-3;  // rad per mrad
    }
  }
  return model;
}

// Elements between neighbouring bodies, of `gaps` in all.
int elements_per_gap(int gaps) { return std::max(1, (kFewestElements + gaps - 1) / gaps); }

void require_beam(double length_mm, double bending_stiffness, double mass_per_m) {
  require_positive("length of the beam (mm)", length_mm);
  require_positive("bending stiffness EI (N m^2)", bending_stiffness);
  require_positive("mass per metre (kg/m)", mass_per_m);
}

void require_gaps(const std::string& what, int bodies, int gaps) {
  require_structure(bodies >= 1 && gaps <= kMostElements, what, bodies,
                    "give 1 to what divides the beam into " + std::to_string(kMostElements) + " parts");
}

void require_deck(const BridgeDeck& deck) {
  require_beam(deck.span_mm, deck.bending_stiffness_n_m2, deck.mass_kg_per_m);
  require_structure(deck.n_spans >= 1 && deck.n_spans <= 20, "number of spans", deck.n_spans, "give 1 to 20");
  require_structure(deck.bodies <= kMostElements, "bodies in each span", deck.bodies, "give fewer");
  require_gaps("bodies in each span", deck.bodies, deck.n_spans * (deck.bodies + 1));
}

}  // namespace

StructureModel cantilever(const Cantilever& tower, const Damping& damping) {
  require_beam(tower.height_mm, tower.bending_stiffness_n_m2, tower.mass_kg_per_m);
  require_gaps("number of bodies", tower.bodies, tower.bodies);
  require_structure(std::isfinite(tower.tip_mass_kg) && tower.tip_mass_kg >= 0.0, "tip mass (kg)", tower.tip_mass_kg,
                    "give 0 or more");
  const int per_gap = elements_per_gap(tower.bodies), n_elements = per_gap * tower.bodies;
  Beam beam(n_elements, 1e-3 * tower.height_mm, tower.bending_stiffness_n_m2, tower.mass_kg_per_m);
  beam.hold(0);
  beam.hold(1);
  beam.mass(2 * n_elements, 2 * n_elements) += tower.tip_mass_kg;
  std::vector<int> nodes;
  for (int i = 1; i <= tower.bodies; ++i) nodes.push_back(i * per_gap);
  StructureModel model = assemble(beam, nodes, StructureModel::Axis::kX);
  set_damping(model, damping);
  validate(model);
  return model;
}

StructureModel bridge_deck(const BridgeDeck& deck, const Damping& damping) {
  require_deck(deck);
  const int gaps = deck.n_spans * (deck.bodies + 1), per_gap = elements_per_gap(gaps), n_elements = per_gap * gaps;
  Beam beam(n_elements, 1e-3 * deck.span_mm * deck.n_spans, deck.bending_stiffness_n_m2, deck.mass_kg_per_m);
  std::vector<int> nodes;
  for (int gap = 0; gap <= gaps; ++gap) {
    if (gap % (deck.bodies + 1) == 0) {
      beam.hold(2 * gap * per_gap);
    } else {
      nodes.push_back(gap * per_gap);
    }
  }
  if (deck.ends == BridgeDeck::Ends::kClamped) {
    beam.hold(1);
    beam.hold(2 * n_elements + 1);
  }
  StructureModel model = assemble(beam, nodes, StructureModel::Axis::kY);
  set_damping(model, damping);
  validate(model);
  return model;
}

std::vector<double> body_positions_mm(const BridgeDeck& deck) {
  require_deck(deck);
  std::vector<double> x_mm;
  for (int span = 0; span < deck.n_spans; ++span) {
    for (int i = 1; i <= deck.bodies; ++i)
      x_mm.push_back(deck.span_mm * (span + static_cast<double>(i) / (deck.bodies + 1)));
  }
  return x_mm;
}

}  // namespace core::simulation
