#pragma once

#include <optional>
#include <string>

#include "core/closure/observation/observation_fit.h"

namespace core::closure {

// A pattern of the residual that an adopted effect leaves of itself, because its form in the model is not exact: small
// beside the effect, at its frequencies, on the points that it moves.
struct Remainder {
  std::string effect;
  double share = 0.0;  // rms of the pattern over that of the effect
};
// pattern_px: 2 points long, of any size. residual: moments of the fit's own residual. Empty: no adopted named effect
// explains it.
[[nodiscard]] std::optional<Remainder> remainder_of(const Eigen::VectorXd& pattern_px, RungSet band,
                                                    const ObservationFit& fit, const ResidualMoments& residual);

}  // namespace core::closure
