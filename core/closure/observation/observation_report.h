#pragma once

#include <string>
#include <vector>

#include "core/closure/closure_level.h"
#include "core/closure/observation/effect.h"
#include "core/closure/observation/observation_fit.h"
#include "core/types/closure_result.h"

namespace core::closure {

// Describes a fit of the observation level to a reader. Pure functions of the fit.

// Effects of the catalogue that this record cannot show, and those that no record of tracks can.
[[nodiscard]] std::vector<NotObservable> not_observable(const ObservationFit& fit,
                                                        const std::vector<const ObservationEffect*>& catalogue);

[[nodiscard]] std::vector<ParameterValue> effect_parameters(const ObservationFit& fit, std::size_t effect);

// Describes a latent effect: place, smoothness, frequency, the signal with which it correlates, the effects whose
// patterns are nearest and how much of it they hold. Empty for named ones.
[[nodiscard]] std::string effect_meaning(const ObservationFit& fit, std::size_t effect,
                                         const std::vector<const ObservationEffect*>& catalogue);

// Describes the leading pattern of the residual: region, axis, share of the low band.
[[nodiscard]] std::string describe_residual(const ObservationFit& fit);

// Noise of the points: size, correlation in time and between points, the period of a video codec.
[[nodiscard]] ClosureLevel::Noise describe_noise(const ObservationFit& fit);

}  // namespace core::closure
