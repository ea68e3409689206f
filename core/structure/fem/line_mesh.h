#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/structure/affine_model.h"
#include "core/structure/fem/bar_basis.h"

namespace core::structure {

enum class Motion { kX = 0, kZ = 1, kTurn = 2 };  // of a node: along x, along z (upwards), rotation in that plane

// A uniform or tapered bar. N, m, kg.
struct Bar {
  double ei = 0.0;              // bending stiffness, N m^2
  double ea = 0.0;              // axial stiffness, N; not used in a mesh without axial motion
  double mass_per_m = 0.0;      // kg/m
  double rotary_per_m = 0.0;    // rotary inertia of the cross-section, kg m; with shear flexibility only
  std::optional<double> shear;  // shear stiffness kappa G A, N; empty: rigid in shear
  std::function<double(double)> stiffness_along, mass_along;  // factors at s = 0 .. 1; empty: 1
};

// Bars between nodes in the plane of x and z, springs and masses at nodes: the finite elements of beam, tower, cable
// and frame2d. Gathers K and M as sums of terms (affine_model.h).
class LineMesh {
 public:
  // axial: bars stretch and nodes move in both directions. Without it only motion across the bars is described, and the
  // caller fixes the other one.
  LineMesh(bool axial, int bubbles) : axial_(axial), bubbles_(bubbles) {}

  std::size_t add_node(double x_m, double z_m);
  std::size_t add_parameter(ModelParameter parameter);
  void fix(std::size_t node, Motion motion) { nodes_[node].dof[static_cast<std::size_t>(motion)] = kFixed; }

  // `part`: parameter that multiplies the bar's stiffness; empty: constant. Returns the bar's number.
  std::size_t add_bar(std::size_t from, std::size_t to, const Bar& bar, std::optional<std::size_t> part);
  // Shear flexibility in series with bending: the bar's shear stiffness is `newton` at s = 0, as the mass along it,
  // over the parameter. `functions`: of the shear (bar_basis.h). Not for a bar with a shear stiffness of its own.
  void add_shear(std::size_t bar, double newton, std::size_t parameter, double least, int functions);
  // The bar is rigid over a length from its first or last end on, the parameter in m from 0 to `most_m`, less than the
  // bar; uniform bars only. Of the two ends of a bar one is meant to be changed at a time.
  void add_rigid_end(std::size_t bar, bool is_last, std::size_t parameter, double most_m);
  // Axial force of a bar, tension positive, N at s = 0 .. 1, times the parameter. is_weight: of the weight of what
  // hangs on the bar, which grows with all lengths.
  void add_tension(std::size_t bar, const std::function<double(double)>& newton, std::size_t parameter,
                   bool is_weight = false);
  // Spring to the ground. kPower: the parameter is its stiffness. kReciprocal: its flexibility, at least `least`.
  void add_spring(std::size_t node, Motion motion, std::size_t parameter, Law law, double least = 0.0);
  // Spring between two nodes along the line that connects them; along x where they lie in one place.
  void add_link(std::size_t from, std::size_t to, std::size_t parameter);
  // The parameter (1 = as declared) multiplies all lengths; sections, springs, forces and point masses stay.
  void set_length(std::size_t parameter) { length_ = parameter; }
  // Mass at a node in both directions, kg: constant, or times a parameter.
  void add_mass(std::size_t node, double kg, std::optional<std::size_t> parameter);
  // Stiffness `factor` (integral of the motion across all bars)^2, times a power of the parameter: sag of a cable.
  void add_uniform_restraint(double factor, std::size_t parameter, int power);

  [[nodiscard]] std::size_t n_bars() const noexcept { return bars_.size(); }

  // The sights' places are projected onto the nearest bar. Throws std::invalid_argument if one is further from every
  // bar than `reach_m`.
  [[nodiscard]] AffineMatrices build(const char* kind, std::vector<Sight> sights, double reach_m) const;

 private:
  static constexpr Eigen::Index kFixed = -1;
  struct Node {
    double x, z;
    std::array<Eigen::Index, 3> dof{0, 0, 0};  // kFixed or free; numbered by build()
  };
  struct PlacedBar {
    std::size_t from, to;
    Bar bar;
    std::optional<std::size_t> part;
  };
  struct Tension {
    std::size_t bar, parameter;
    std::function<double(double)> newton;
    int power;  // of all lengths
  };
  struct Spring {
    std::size_t node, parameter;
    Motion motion;
    Law law;
    double least;
  };
  struct Mass {
    std::size_t node;
    double kg;
    std::optional<std::size_t> parameter;
  };
  struct Restraint {
    double factor;
    std::size_t parameter;
    int power;
  };
  struct Shear {
    std::size_t bar, parameter;
    double newton, least;
    int functions;
  };
  struct RigidEnd {
    std::size_t bar, parameter;
    bool is_last;
    double most_m;
  };
  struct Link {
    std::size_t from, to, parameter;
  };
  // A part of a bar's matrices: what it is proportional to, and as which power of all lengths (rotations times length).
  struct Piece {
    std::vector<Factor> factors;
    int power = 0;
    bool is_mass = false;
    Eigen::MatrixXd matrix;
  };
  class Assembly;
  class Terms;

  [[nodiscard]] BarBasis basis(std::size_t bar) const { return basis(bar, length(bar)); }
  [[nodiscard]] BarBasis basis(std::size_t bar, double length_m) const;
  [[nodiscard]] double length(std::size_t bar) const;
  [[nodiscard]] const Shear* shear_of(std::size_t bar) const;
  [[nodiscard]] std::vector<Piece> pieces(std::size_t bar, const BarBasis& shape) const;
  [[nodiscard]] std::vector<Piece> pieces_with_rigid_end(const RigidEnd& end, double length_m) const;
  [[nodiscard]] std::vector<Piece> changes_by(const RigidEnd& end) const;
  [[nodiscard]] int n_points() const noexcept { return bubbles_ + 8; }  // of the rule; tapered bars need some more
  void add_bars(Terms& terms) const;
  void add_nodes(const Assembly& assembly, Terms& terms) const;
  [[nodiscard]] Eigen::VectorXd across(const Assembly& assembly) const;
  [[nodiscard]] std::vector<DrawnItem> drawing() const;
  [[nodiscard]] Eigen::VectorXd seen_by(const Sight& sight, const Assembly& assembly, double reach_m) const;

  bool axial_;
  int bubbles_;
  std::vector<Node> nodes_;
  std::vector<PlacedBar> bars_;
  std::vector<Tension> tensions_;
  std::vector<Spring> springs_;
  std::vector<Mass> masses_;
  std::vector<Restraint> restraints_;
  std::vector<Shear> shears_;
  std::vector<RigidEnd> rigid_ends_;
  std::vector<Link> links_;
  std::optional<std::size_t> length_;
  std::vector<ModelParameter> parameters_;
};

}  // namespace core::structure
