#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/structure/kinds/connection.h"
#include "core/structure/structural_model.h"

namespace core::structure {

// Bars, rigidly connected at nodes, in the plane of x and z: portal, truss with stiff joints, bridge with piers.
struct Frame2d {
  struct Node {
    std::string name;
    double x_m = 0.0, z_m = 0.0, mass_kg = 0.0;
    Connection x = Connection::free(), z = Connection::free(), rotation = Connection::free();
  };
  struct Member {
    std::string name, from, to;
    double ei_nm2 = 0.0, ea_n = 0.0, mass_per_m_kg = 0.0;
    std::optional<double> shear_n;
    double axial_n = 0.0;  // tension positive
    std::string group;     // members of one group share a stiffness factor; empty: its own
  };
  // A spring between two nodes along the line that connects them (along x where they lie in one place): of two
  // structures in one file, or of two parts of one. 0: a place where there may be one.
  struct Coupling {
    std::string from, to;
    double stiffness_n_per_m = 0.0;
  };
  std::vector<Node> nodes;
  std::vector<Member> members;
  std::vector<Coupling> couplings;
  double spring_prior = 0.0, part_prior = 0.0;
};

// Throws std::invalid_argument with the node's or member's name, value, range and remedy.
[[nodiscard]] std::unique_ptr<StructuralModel> make_frame2d(const Frame2d& frame, std::vector<Sight> sights);

}  // namespace core::structure
