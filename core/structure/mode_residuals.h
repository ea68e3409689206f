#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/structure/frame_fit.h"

namespace core::structure {

// Residuals of one reference mode in units of its sigmas: frequency, then the shape's components at the best scale.
void append_residuals(const FrameModes& modes, const ReferenceMode& mode, std::vector<double>& out);

// Of all modes but `without` (-1: of all), of the priors and of parameters over FrameModel::limits. False: there are no
// modes, or a residual is not finite.
[[nodiscard]] bool residuals_of(const FrameModel& model, const std::vector<ReferenceMode>& reference, int without,
                                const Eigen::VectorXd& parameters, Eigen::VectorXd& out);

// True if the residuals' derivatives follow from those of the modes: not for a shear frame, nor with an effect that
// changes the frequencies observed (StructuralEffect::changes_frequencies()).
[[nodiscard]] bool has_analytic_jacobian(const FrameModel& model);
// Derivatives of all residuals, the priors' included; columns of places are zero. False if there are no modes.
[[nodiscard]] bool analytic_jacobian(const FrameModel& model, const std::vector<ReferenceMode>& reference, int without,
                                     const Eigen::VectorXd& parameters, Eigen::MatrixXd& out);

}  // namespace core::structure
