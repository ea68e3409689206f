#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace core::structure {

// Physical meaning of a parameter: an effect finds the parameters that it may change by their role.
enum class Role {
  kPartStiffness,     // factor of the stiffness of one part (element, storey, group); 1 = as declared
  kAddedMass,         // additional mass at one place; 0 = as declared
  kSupportTurning,    // rotational flexibility of one support, rad/(N m)
  kSupportYielding,   // flexibility of one support against displacement, m/N
  kSpring,            // stiffness of a declared spring: soil, pier, guy; N/m or N m/rad
  kAxialForce,        // tension positive, N
  kGravity,           // factor of the weight's softening; 1 = as declared
  kShearFlexibility,  // of all cross-sections, in series with bending; 0 = rigid in shear
  kRigidEnd,          // length over which one end of a member is rigid, m
  kCoupling,          // stiffness of a spring between two declared places, N/m
  kLength,            // factor of all lengths; 1 = as declared
  kOther
};

// Values are in the parameter's unit. `value` is the declared one; the prior is a normal distribution about it.
struct ModelParameter {
  std::string name, unit;
  Role role = Role::kOther;
  double value = 0.0;
  double low = 0.0, high = 0.0;  // bounds
  double scale = 1.0;            // typical size of a noticeable change, > 0
  double prior_sigma = 0.0;      // 0: the declared value is exact
  std::string place;             // "storey 3", "12.5 m"; empty: the whole structure
};

// Where and along which direction a channel sees the structure's motion. Coordinates of the structure: z upwards.
struct Sight {
  std::string channel;
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  // unit length; the camera's line of sight is projected out
};

// A part of a drawing of the structure, in its plane of x and z: a bar, or a node where both ends are one place.
struct DrawnItem {
  std::optional<std::size_t> parameter;  // that changes it; empty: none
  Eigen::Vector2d from_m = Eigen::Vector2d::Zero(), to_m = Eigen::Vector2d::Zero();

  [[nodiscard]] bool is_node() const { return from_m == to_m; }
};

struct ModelModes {
  Eigen::VectorXd frequency_hz;  // ascending; rigid-body motion is left out
  Eigen::MatrixXd shapes;        // sights x modes; modal mass 1 kg (relative where masses are relative)
  // One per requested parameter; empty if not requested. Of equal frequencies only the sum is defined.
  Eigen::MatrixXd d_frequency_hz;         // modes x requested
  std::vector<Eigen::MatrixXd> d_shapes;  // sights x modes each
};

// A structure whose modes depend on named parameters. Immutable; any thread may call it.
class StructuralModel {
 public:
  StructuralModel() = default;
  StructuralModel(const StructuralModel&) = delete;
  StructuralModel& operator=(const StructuralModel&) = delete;
  virtual ~StructuralModel() = default;

  [[nodiscard]] virtual std::string_view kind() const noexcept = 0;
  [[nodiscard]] virtual const std::vector<ModelParameter>& parameters() const noexcept = 0;
  [[nodiscard]] virtual const std::vector<Sight>& sights() const noexcept = 0;
  // Empty: the kind has no geometry.
  [[nodiscard]] virtual std::vector<DrawnItem> drawing() const { return {}; }
  // The lowest modes, at most `n_modes`, with derivatives by the parameters of these indices. Empty if the structure
  // has no stiffness left (it buckles), or if values are not finite. `values`: one per parameter.
  [[nodiscard]] virtual std::optional<ModelModes> modes(const Eigen::VectorXd& values, std::size_t n_modes,
                                                        const std::vector<std::size_t>& derivatives) const = 0;
};

[[nodiscard]] Eigen::VectorXd declared_values(const StructuralModel& model);
// Indices of the parameters of one role, in their order.
[[nodiscard]] std::vector<std::size_t> parameters_of(const StructuralModel& model, Role role);

}  // namespace core::structure
