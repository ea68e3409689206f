#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/structure/declared_frame.h"

namespace core::structure {

// Damping ratio over frequency, as mechanisms of damping have it (Chopra, Dynamics of Structures, 11.4).
enum class DampingLaw {
  kMassProportional,       // viscous, C = alpha M: zeta = a / f; air, water
  kStiffnessProportional,  // viscous, C = beta K: zeta = b f; strain rate
  kConstant,               // hysteretic: the same ratio at every frequency; friction in material and joints
  kRayleigh                // viscous, C = alpha M + beta K: zeta = a / f + b f
};
[[nodiscard]] std::string_view name_of(DampingLaw law) noexcept;

// A law fitted to the damping ratios of all modes that have one, coefficients at least 0.
struct DampingLawFit {
  DampingLaw law = DampingLaw::kConstant;
  double per_hz = 0.0, per_hz_sigma = 0.0;  // b, s
  double hz = 0.0, hz_sigma = 0.0;          // a, Hz
  double ratio = 0.0, ratio_sigma = 0.0;    // of the constant law
  double heldout_percent = 0.0;             // rms relative error of each mode's ratio, predicted by a fit to the others
  double chi2 = 0.0;
  double degrees_of_freedom = 0.0;
  bool is_possible = false;  // neither refuted by itself nor against another law
};

struct DampingVerdict {
  std::size_t n_modes = 0;          // that have a damping ratio with a sigma
  std::vector<DampingLawFit> laws;  // in the order of DampingLaw; empty: too few modes
  // Laws that the sigmas leave: one is reported, of several none. Rayleigh's only where it explains more than its
  // parts.
  [[nodiscard]] std::vector<DampingLaw> possible() const;
};

inline constexpr std::size_t kLeastDampedModes = 3;  // any law of two coefficients explains two modes

// Weighted least squares of the laws. A law is refuted if its chi^2 exceeds the 99.7 % level, or the least of all laws
// by more than nine.
[[nodiscard]] DampingVerdict damping_verdict(const std::vector<ReferenceMode>& reference);

// One paragraph for a reader: which law, with its coefficient, or why none is reported. Empty: no mode has a damping
// ratio.
[[nodiscard]] std::string damping_words(const DampingVerdict& verdict);

}  // namespace core::structure
