#pragma once

#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "core/structure/structural_model.h"

namespace core::structure {

using SparseMatrix = Eigen::SparseMatrix<double>;

// Coefficient of a term as a function of its parameter p.
enum class Law {
  kLinear,        // p
  kReciprocal,    // 1 / p, p at least the term's `least`: 0 is a rigid connection within rounding
  kInverseSquare  // 1 / p^2
};

// A part of the matrices that is proportional to a function of one parameter.
struct AffineTerm {
  std::size_t parameter = 0;
  Law law = Law::kLinear;
  double least = 0.0;            // kReciprocal: smaller values count as this
  SparseMatrix stiffness, mass;  // symmetric, both triangles; empty (0 x 0): the term has none
};

// K(p) = K_0 + sum c_j(p) K_j, M(p) = M_0 + sum c_j(p) M_j: every kind whose matrices are sums of parts.
struct AffineMatrices {
  std::string kind;
  std::vector<ModelParameter> parameters;
  std::vector<Sight> sights;
  SparseMatrix stiffness, mass;  // K_0, M_0: dof x dof; M may be singular (massless degrees of freedom)
  std::vector<AffineTerm> terms;
  Eigen::MatrixXd readout;  // sights x dof
};

// Modes by a dense solver: cost grows with the cube of the number of degrees of freedom (1 ms for 50). Larger matrices
// are reduced first (kinds/matrices.h). Derivatives are analytic (Fox & Kapoor 1968, over all modes).
class AffineModel final : public StructuralModel {
 public:
  explicit AffineModel(AffineMatrices matrices);

  [[nodiscard]] std::string_view kind() const noexcept override { return matrices_.kind; }
  [[nodiscard]] const std::vector<ModelParameter>& parameters() const noexcept override { return matrices_.parameters; }
  [[nodiscard]] const std::vector<Sight>& sights() const noexcept override { return matrices_.sights; }
  [[nodiscard]] std::optional<ModelModes> modes(const Eigen::VectorXd& values, std::size_t n_modes,
                                                const std::vector<std::size_t>& derivatives) const override;

  [[nodiscard]] const AffineMatrices& matrices() const noexcept { return matrices_; }
  [[nodiscard]] Eigen::MatrixXd stiffness(const Eigen::VectorXd& values) const;
  [[nodiscard]] Eigen::MatrixXd mass(const Eigen::VectorXd& values) const;

 private:
  AffineMatrices matrices_;
};

// c(p) and its derivative.
[[nodiscard]] double coefficient(const AffineTerm& term, double p) noexcept;
[[nodiscard]] double coefficient_slope(const AffineTerm& term, double p) noexcept;

}  // namespace core::structure
