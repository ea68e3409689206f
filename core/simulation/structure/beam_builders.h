#pragma once

#include <cstdint>
#include <vector>

#include "core/simulation/structure/structure_damping.h"
#include "core/simulation/structure/structure_model.h"

namespace core::simulation {

// Uniform Euler-Bernoulli beams of two-node elements with cubic shapes, deflection and slope of every node as
// coordinates, and the mass matrix consistent with them (Clough & Penzien, Dynamics of Structures, 10.3; Przemieniecki,
// Theory of Matrix Structural Analysis, 11.3). Coordinates count mm and mrad, matrices SI, as in structure_builders.h.
// At least 24 elements over the whole beam: the frequencies of its first five modes lie less than 2e-4 above the exact.
// The face of a section rotates with the slope. All throw std::invalid_argument.

// A tower clamped at its foot that sways along X. Body i at height i / bodies; leaning to +X it tilts by +dX/dh.
// f_r = lambda_r^2 / (2 pi L^2) sqrt(EI / m), lambda = 1.875104, 4.694091, 7.854757, ... without tip mass.
struct Cantilever {
  double height_mm = 0.0;
  int bodies = 1;
  double bending_stiffness_n_m2 = 0.0;  // EI
  double mass_kg_per_m = 0.0;
  double tip_mass_kg = 0.0;
};
[[nodiscard]] StructureModel cantilever(const Cantilever& tower, const Damping& damping);

// A deck that moves up and down (Y), on supports that do not sink. Bodies divide each span into equal parts, none over
// a support; tilt dY/dx. Simply supported: f_r = r^2 pi / (2 L^2) sqrt(EI / m). Clamped, at the two ends only: as the
// cantilever's formula with lambda = 4.730041, 7.853205, ... (Blevins, Formulas for Natural Frequency, table 8-1).
struct BridgeDeck {
  enum class Ends : std::uint8_t { kSimple, kClamped };
  double span_mm = 0.0;
  int bodies = 1;   // in each span
  int n_spans = 1;  // equal, the deck runs through over the piers
  double bending_stiffness_n_m2 = 0.0;
  double mass_kg_per_m = 0.0;
  Ends ends = Ends::kSimple;
};
[[nodiscard]] StructureModel bridge_deck(const BridgeDeck& deck, const Damping& damping);

// Where the deck's bodies lie: distance from its left end.
[[nodiscard]] std::vector<double> body_positions_mm(const BridgeDeck& deck);

}  // namespace core::simulation
