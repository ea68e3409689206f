#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/structure/frame_fit.h"

namespace core::structure {

// Cross-validation of a linear least-squares model in closed form [Allen 1974], one reference mode at a time: the
// residuals of mode i, predicted by a fit to all others, are (I - H_ii)^-1 r_i, r = (I - H) d, H = J (J^T J + W)^-1 J^T
// with the Jacobian J and the inverse squares W of FrameModel::limits_at(). Data d and residuals are in sigmas, rows as
// in FrameFit::jacobian.
class HeldOutModes {
 public:
  // Parameters that lie at a bound, and places, are held. Empty: too few modes determine the parameters.
  [[nodiscard]] static std::optional<HeldOutModes> about(const FrameModel& model,
                                                         const std::vector<ReferenceMode>& reference,
                                                         const FrameFit& fit);

  [[nodiscard]] Eigen::VectorXd fitted_residuals(const Eigen::VectorXd& data) const;
  // Squares of the predicted residuals of all modes, those of the fit given.
  [[nodiscard]] double chi2(const Eigen::VectorXd& fitted_residuals) const;
  // The same with one further parameter, whose direction is a unit vector orthogonal to the columns; limited likewise.
  [[nodiscard]] double chi2_with(const Eigen::VectorXd& direction, const Eigen::VectorXd& fitted_residuals) const;

 private:
  Eigen::MatrixXd basis_;                 // of the columns, with W orthonormal: H = basis basis^T
  std::vector<Eigen::MatrixXd> inverse_;  // (I - H_ii)^-1 of each reference mode
};

// Effects that a model may lack, in first order about its fit: what a small change of each at each of its places does
// to the residuals, apart from what the model's own parameters do. A surrogate costs products of small matrices in
// place of hundreds of fits. Immutable.
class FirstOrderEffects {
 public:
  // Empty if one of the effects has no parameter of size, several, or no finite value without the effect, or if modes
  // are too few.
  [[nodiscard]] static std::optional<FirstOrderEffects> about(const FrameModel& model,
                                                              const std::vector<const StructuralEffect*>& effects,
                                                              const std::vector<ReferenceMode>& reference,
                                                              const FrameFit& fit);

  // Largest decrease of chi^2 by one effect at one place (score test, Rao 1948). `data`: of the model without an
  // effect, in sigmas.
  [[nodiscard]] double largest_gain(const Eigen::VectorXd& data) const;
  // Largest decrease of the held-out chi^2 by one effect, each at the place where it explains most; at least 0.
  [[nodiscard]] double largest_score(const Eigen::VectorXd& data) const;

 private:
  struct Direction {
    std::size_t effect;
    bool is_one_sided;  // the effect cannot be negative
  };
  [[nodiscard]] double gain(std::size_t i, double along) const;

  std::optional<HeldOutModes> held_out_;
  std::vector<Direction> directions_;
  Eigen::MatrixXd unit_;  // data x directions: orthogonal to the model's own columns, pointing to larger effects
  std::size_t n_effects_ = 0;
};

}  // namespace core::structure
