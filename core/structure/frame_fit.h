#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/structure/structural_effect.h"

namespace core::structure {

// A shear frame or another kind of structure with effects, to be fitted to reference modes. Parameters: ln(stiffness
// over mass) unless declared, those of the kind that have a prior, in units of its standard deviation from the declared
// value, then those of the effects in their order. Borrows all members.
struct FrameModel {
  const DeclaredFrame* declared = nullptr;
  std::vector<const StructuralEffect*> effects;
  // Standard deviations of normal distributions of the parameters about no effect; infinite, or empty: none.
  Eigen::VectorXd limits = {};

  [[nodiscard]] bool has_scale() const noexcept { return !declared->stiffness_over_mass_per_s2; }
  // Parameters of the kind that have a prior.
  [[nodiscard]] std::vector<std::size_t> with_prior() const;
  // Number of parameters before those of the effects.
  [[nodiscard]] Eigen::Index n_scale() const;
  [[nodiscard]] Eigen::Index n_parameters() const { return first_of(effects.size()); }
  // Index of an effect's first parameter; of effects.size(): the number of all parameters.
  [[nodiscard]] Eigen::Index first_of(std::size_t i_effect) const;
  // `limits` for cross-validation about a fit: each effect's size there. Infinite for all other parameters, where "no
  // effect" is not a number, and for the plain shear frame.
  [[nodiscard]] Eigen::VectorXd limits_at(const Eigen::VectorXd& parameters) const;
  // Value of each parameter without the effects.
  [[nodiscard]] Eigen::VectorXd neutral() const;
  // Parameters of one effect, from the vector of all parameters.
  [[nodiscard]] std::vector<double> of_effect(std::size_t i_effect, const Eigen::VectorXd& parameters) const;
};

// The frame as declared, with `stiffness_over_mass_per_s2` for ratio 1.
[[nodiscard]] ShearFrame uniform_frame(const DeclaredFrame& declared, double stiffness_over_mass_per_s2);
// Empty vectors for another kind.
[[nodiscard]] ShearFrame frame_of(const FrameModel& model, const Eigen::VectorXd& parameters);
// Of another kind: the values of its parameters.
[[nodiscard]] Eigen::VectorXd values_of(const FrameModel& model, const Eigen::VectorXd& parameters);
// Modes as observed; empty if the frame has none. Modes of another kind are numbered as in the declared model: where
// two exchange places on the frequency axis, numbers follow the shapes (MAC at the sights).
[[nodiscard]] std::optional<FrameModes> seen_modes(const FrameModel& model, const Eigen::VectorXd& parameters,
                                                   bool with_shapes);

struct FrameFit {
  bool ok = false;             // false: no parameters give a frame, or no initial value lies within bounds
  Eigen::VectorXd parameters;  // within the effects' bounds
  double chi2 = 0.0;           // sum of squared residuals in units of the reference's sigmas
  Eigen::Index n_data = 0;
  Eigen::Index n_scales = 0;   // shapes: each is compared at its best scale
  Eigen::VectorXd residuals;   // of the reference modes in their order (frequency, shape), then of the priors
  Eigen::MatrixXd jacobian;    // of those residuals; n_data x parameters
  std::vector<bool> is_place;  // parameters that count places; they have no derivative
  std::vector<bool> is_at_bound;

  [[nodiscard]] double degrees_of_freedom() const { return static_cast<double>(n_data - n_scales - parameters.size()); }
};

enum class Starts { kAll, kBest };  // initial values: all of each effect, or the best-fitting one

// Least squares by Levenberg-Marquardt with bounds (Nocedal & Wright 10.3, 16.7). Residuals: relative error of every
// reference frequency over its sigma, each shape's components, at the best scale, over their sigmas, and each parameter
// that has a prior over its standard deviation. Initial
// values: those of the last effect, and `before` for all others (from the model without the last effect), or `before`
// alone if it has all parameters. `without`: index in `reference` that is held out; -1 none.
[[nodiscard]] FrameFit fit_frame(const FrameModel& model, const std::vector<ReferenceMode>& reference,
                                 const Eigen::VectorXd& before, Starts starts, int without = -1);

// Cross-validation: each reference mode is predicted by a fit to all others, in which effects are limited to their
// sizes in `fit` (FrameModel::limits_at): where one mode alone shows an effect, the others predict that mode without
// it. The frequencies of the others alone must determine the parameters: shapes help, but their sigmas are often
// assumed.
struct LeaveOneOut {
  std::vector<double> relative_error;  // of the frequency, per reference mode; empty: too few modes
  double chi2 = 0.0;                   // of frequencies and shapes
  double rms_percent = 0.0;            // of the frequencies; infinite if it cannot be determined
  // The same with the shapes: an error of a component counts as one of the frequency of as many sigmas, a mode's
  // components as their mean square. Without shapes rms_percent.
  double with_shapes_percent = 0.0;
};
// Whether the reference's frequencies, one held out, are at least as many as the parameters.
[[nodiscard]] bool determines(const FrameModel& model, const std::vector<ReferenceMode>& reference,
                              const FrameFit& fit);
[[nodiscard]] LeaveOneOut leave_one_out(const FrameModel& model, const std::vector<ReferenceMode>& reference,
                                        const FrameFit& fit);

// Covariance of the parameters about the fit; NaN where they are places, at a bound or not determined by the data.
[[nodiscard]] Eigen::MatrixXd parameter_covariance(const FrameFit& fit);
// Standard deviations of the parameters; NaN at a bound or if the data do not determine one.
[[nodiscard]] Eigen::VectorXd parameter_sigmas(const FrameFit& fit);

// The 99.7 % level of chi-square with these degrees of freedom (Wilson & Hilferty 1931).
[[nodiscard]] double chi2_limit(double degrees_of_freedom);

}  // namespace core::structure
