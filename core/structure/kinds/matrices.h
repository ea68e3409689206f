#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/structure/affine_model.h"
#include "core/structure/structural_model.h"

namespace core::structure {

// Stiffness and mass of any finite-element program: K(p) = K + sum (p_i - 1) K_i, and the same of M. One consistent set
// of units whose time is the second.
struct MatrixStructure {
  struct Group {
    std::string name;
    SparseMatrix stiffness, mass;  // its part of K and M; one of them may be empty (0 x 0)
    double prior = 0.0;            // relative standard deviation of its factor
  };
  struct Seen {  // channel = sum of weight times degree of freedom
    std::string channel;
    std::vector<std::pair<std::size_t, double>> dofs;  // from 0
  };
  SparseMatrix stiffness, mass;
  std::vector<Group> groups;
  std::vector<Seen> seen;
  std::size_t n_modes = 12;  // that the reduced model describes
};

inline constexpr std::size_t kMostMatrixDofs = 200'000, kMostMatrixGroups = 100;

// Reduces the matrices once: to the lowest modes, twice as many as n_modes, and the static response to the change of
// each group in each mode, of which the most important directions are kept. At the declared values modes are exact; a
// group's factor p changes them with an error of the order (p - 1)^2 times the truncation. Cost: one factor, some
// hundreds of solutions. Throws std::invalid_argument: not square, other size, not symmetric, not finite, singular, ...
[[nodiscard]] std::unique_ptr<StructuralModel> make_matrices(const MatrixStructure& declared);

// The modes at these factors of the groups without reduction: one factor. Columns of seen channels x modes.
[[nodiscard]] ModelModes exact_modes(const MatrixStructure& declared, const std::vector<double>& factors,
                                     std::size_t n_modes);

}  // namespace core::structure
