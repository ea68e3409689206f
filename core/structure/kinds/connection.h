#pragma once

#include <string>

#include "core/structure/fem/line_mesh.h"

namespace core::structure {

// How a node is held to the ground in one motion.
struct Connection {
  enum class Kind { kFree, kRigid, kSpring } kind = Kind::kFree;
  double stiffness = 0.0;  // of a spring: N/m or N m/rad

  [[nodiscard]] static Connection free() { return {}; }
  [[nodiscard]] static Connection rigid() { return {Kind::kRigid, 0.0}; }
  [[nodiscard]] static Connection spring(double stiffness) { return {Kind::kSpring, stiffness}; }
};

// Relative flexibility of a rigid connection within the model, and stiffness beyond which a spring counts as rigid.
inline constexpr double kRigidFlexibility = 1e-13;

// Adds the connection and its parameter: for a rigid one its flexibility (declared 0), for a spring its stiffness, for
// free rotation the stiffness of a restraint (declared 0). `typical`: stiffness of the structure at that node, against
// which connections are stiff or soft. `prior`: relative standard deviation of a declared spring.
void connect(LineMesh& mesh, std::size_t node, Motion motion, const Connection& connection, double typical,
             const std::string& name, const std::string& place, double prior = 0.0);

// A mass that may sit at the node although none is declared; kg, up to `most`.
void add_possible_mass(LineMesh& mesh, std::size_t node, double most, const std::string& name,
                       const std::string& place);

// Parameters that bars of every kind have; `scale` of the first: change that is noticeable.
[[nodiscard]] ModelParameter shear_parameter(const char* unit, double scale);
[[nodiscard]] ModelParameter rigid_end_parameter(const std::string& name, const std::string& place, double most_m);
[[nodiscard]] ModelParameter length_parameter();
// Functions of the shear in series of each bar (bar_basis.h), so that frequencies with it are exact to about 1e-6.
[[nodiscard]] int shear_functions_for(std::size_t n_bars) noexcept;
// A rigid end is at most this share of its bar.
inline constexpr double kMostRigidEnd = 0.5;

// Bubbles of each bar so that the lowest twelve modes of the whole are exact to about 1e-9.
[[nodiscard]] int bubbles_for(std::size_t n_bars) noexcept;

// "12.5 m"
[[nodiscard]] std::string place_text(double at_m);

}  // namespace core::structure
