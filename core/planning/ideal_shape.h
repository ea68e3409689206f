#pragma once

#include <vector>

namespace core::planning {

enum class StructureKind {
  kShearChain,  // equal floors on equal columns, fixed at the ground: a frame
  kCantilever,  // uniform bending beam, clamped at position 0: a tower, a chimney
  kBeam         // uniform bending beam, simply supported: a bridge deck
};

// Mode `number` (1, 2, ...) of the ideal structure at the positions x / L in 0 .. 1, scaled to a largest component
// of 1.
//   shear chain of n floors: sin((2 r - 1) i pi / (2 n + 1)), i = x n / L, floor n at the top
//   cantilever: cosh bx - cos bx - k (sinh bx - sin bx), cos b cosh b = -1, k = (cosh b + cos b) / (sinh b + sin b)
//   beam: sin(r pi x / L)
// (Blevins, Formulas for Natural Frequency and Mode Shape, tables 6-2 and 8-1.)
// Throws std::invalid_argument: more modes than floors of a shear chain, or positions outside 0 .. 1.
[[nodiscard]] std::vector<double> ideal_shape(StructureKind kind, int number, const std::vector<double>& positions,
                                              int n_floors);

}  // namespace core::planning
