#pragma once

#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "core/structure/structural_model.h"

namespace core::structure {

using SparseMatrix = Eigen::SparseMatrix<double>;

enum class Law {
  kPower,       // p^power
  kReciprocal,  // 1 / p, p at least `least`: 0 is a rigid connection within rounding
  kLagrange     // polynomial that is 1 at points[at] and 0 at all other points
};

// A function of one parameter p.
struct Factor {
  std::size_t parameter = 0;
  Law law = Law::kPower;
  int power = 1;
  double least = 0.0;
  std::vector<double> points = {};
  std::size_t at = 0;

  [[nodiscard]] static Factor of_power(std::size_t parameter, int power) { return {parameter, Law::kPower, power}; }
  [[nodiscard]] static Factor reciprocal(std::size_t parameter, double least) {
    return {parameter, Law::kReciprocal, 1, least};
  }
  [[nodiscard]] double value(double p) const noexcept;
  [[nodiscard]] double slope(double p) const noexcept;
};

// A part of the matrices that is proportional to the product of its factors; none: constant.
struct AffineTerm {
  std::vector<Factor> factors;
  SparseMatrix stiffness, mass;  // symmetric, both triangles; empty (0 x 0): the term has none

  [[nodiscard]] double value(const Eigen::VectorXd& values) const noexcept;
  // Derivative by one parameter.
  [[nodiscard]] double slope(const Eigen::VectorXd& values, std::size_t parameter) const noexcept;
};

// Degrees of freedom that are at rest while a parameter is 0: what it makes flexible is rigid then.
struct RigidPart {
  std::size_t parameter = 0;
  std::vector<Eigen::Index> dofs;
};

// K(p) = K_0 + sum c_j(p) K_j, M(p) = M_0 + sum c_j(p) M_j: every kind whose matrices are sums of parts.
struct AffineMatrices {
  std::string kind;
  std::vector<ModelParameter> parameters;
  std::vector<Sight> sights;
  SparseMatrix stiffness, mass;  // K_0, M_0: dof x dof; M may be singular (massless degrees of freedom)
  std::vector<AffineTerm> terms;
  std::vector<RigidPart> rigid;
  Eigen::MatrixXd readout;  // sights x dof
  std::vector<DrawnItem> drawing = {};
};

// Modes by a dense solver: cost grows with the cube of the number of degrees of freedom (1 ms for 50). Larger matrices
// are reduced first (kinds/matrices.h). Derivatives are analytic (Fox & Kapoor 1968, over all modes).
class AffineModel final : public StructuralModel {
 public:
  explicit AffineModel(AffineMatrices matrices);

  [[nodiscard]] std::string_view kind() const noexcept override { return matrices_.kind; }
  [[nodiscard]] const std::vector<ModelParameter>& parameters() const noexcept override { return matrices_.parameters; }
  [[nodiscard]] const std::vector<Sight>& sights() const noexcept override { return matrices_.sights; }
  [[nodiscard]] std::vector<DrawnItem> drawing() const override { return matrices_.drawing; }
  [[nodiscard]] std::optional<ModelModes> modes(const Eigen::VectorXd& values, std::size_t n_modes,
                                                const std::vector<std::size_t>& derivatives) const override;

  [[nodiscard]] const AffineMatrices& matrices() const noexcept { return matrices_; }
  [[nodiscard]] Eigen::MatrixXd stiffness(const Eigen::VectorXd& values) const;
  [[nodiscard]] Eigen::MatrixXd mass(const Eigen::VectorXd& values) const;

 private:
  // Those that move: all but the rigid parts' whose parameter is 0 and whose derivative is not requested.
  [[nodiscard]] std::vector<Eigen::Index> moving(const Eigen::VectorXd& values,
                                                 const std::vector<std::size_t>& derivatives) const;

  AffineMatrices matrices_;
};

}  // namespace core::structure
