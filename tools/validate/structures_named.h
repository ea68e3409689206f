#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/structure/declared_frame.h"
#include "tools/validate/drawn_scene.h"

namespace tools {

// Matrices of a structure that share no code with the model fitted: those of core/simulation, or textbook elements.
struct TrueMatrices {
  Eigen::MatrixXd stiffness, mass;
  Eigen::MatrixXd seen;  // places x degrees of freedom
};

// A structure of one kind that lacks one effect, drawn from a seed.
struct NamedCase {
  core::structure::DeclaredFrame declared;
  TrueMatrices truth;
  std::size_t place = 0;  // number of the place among those of the effect, from 1; 0: it has one only
  double size = 0.0;      // in the unit of the effect's parameter
};

struct NamedKind {
  std::string kind, effect;
  NamedCase (*draw)(const std::string& effect, Draw& draw);
};
// Every kind with every effect where it makes sense; a file each group of kinds.
[[nodiscard]] std::vector<NamedKind> named_kinds();
[[nodiscard]] NamedCase draw_tower(const std::string& effect, Draw& draw);
[[nodiscard]] NamedCase draw_beam(const std::string& effect, Draw& draw);
[[nodiscard]] NamedCase draw_cable(const std::string& effect, Draw& draw);
[[nodiscard]] NamedCase draw_storeys(const std::string& effect, Draw& draw);
[[nodiscard]] NamedCase draw_frame2d(const std::string& effect, Draw& draw);
[[nodiscard]] NamedCase draw_matrices(const std::string& effect, Draw& draw);
[[nodiscard]] NamedCase draw_masts(const std::string& effect, Draw& draw);  // two of them
[[nodiscard]] NamedCase draw_mode_table(const std::string& effect, Draw& draw);

// Of several files of cases. Relative change of stiffness per kelvin of a polymer's or asphalt's; a factor of all
// lengths; a change of temperature; the declaration that an effect needs: stiffness known, coefficients of temperature.
inline constexpr double kWarmPerKelvin = -2e-3;
[[nodiscard]] double drawn_length(Draw& draw);
void warm(NamedCase& out, Draw& draw);
[[nodiscard]] core::structure::DeclaredFrame declared_as(std::unique_ptr<core::structure::StructuralModel> model,
                                                         const std::string& effect);

inline constexpr std::size_t kNamedParts = 6, kNamedElements = 60, kMostNamedModes = 6;

// The simulator's cantilever or deck of kNamedElements elements, to be changed by parts.
class TrueBar {
 public:
  enum class Ends { kFoot, kHinges };  // clamped at its start; hinged at both ends
  // E I = 1 N m^2, 1 kg/m: with length 1 only ratios matter.
  explicit TrueBar(Ends ends, double length_m = 1.0);

  void scale_part(std::size_t part, double ratio);  // its bending stiffness, from 1
  // Elements that do not bend, from 0: 1e4 times as stiff, which leaves less than 1e-4 of their share.
  void stiffen(std::size_t first, std::size_t count);
  void shear(double flexibility);                 // 1 / (shear stiffness): a new bar, before anything else
  void add_mass(std::size_t node, double share);  // of the whole mass
  void add_tension(double newton);                // uniform
  // Compression by the weight above: weight of the whole = `newton`.
  void add_weight(double newton);
  void add_spring(std::size_t node, bool turns, double stiffness);
  // Flexibility against rotation of the clamped foot: the bar turns as a rigid body.
  void add_turning(double flexibility);
  // A held end moves, on a spring. Its inertia and stiffness follow from those of the free nodes and of rigid motion.
  void release(std::size_t node, double stiffness);
  [[nodiscard]] Eigen::MatrixXd part(std::size_t number) const;  // its stiffness, from 1
  // n places; the nodes' numbers.
  std::vector<std::size_t> look(int n_places);
  [[nodiscard]] const TrueMatrices& matrices() const noexcept { return out_; }

 private:
  [[nodiscard]] Eigen::Index dof(std::size_t node, bool turns) const;  // -1: held
  void add(Eigen::MatrixXd& to, std::size_t element, const Eigen::Matrix4d& part) const;

  Ends ends_;
  double length_m_, element_m_;
  TrueMatrices out_;
  Eigen::VectorXd influence_;  // inertia of all nodes in translation, held ones included
};

// Sights along a bar of length 1 at these nodes.
[[nodiscard]] std::vector<core::structure::Sight> bar_sights(const std::vector<std::size_t>& nodes, bool upright);

// Every case, n_seeds of each: effect named and nothing else, interval, held-out errors, rivals.
void print_structure_effects(int n_seeds, int n_threads, int first_seed);
// Mechanisms of damping, n_seeds of each.
void print_structure_damping(int n_seeds, int n_threads, int first_seed);

}  // namespace tools
