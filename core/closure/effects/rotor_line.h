#pragma once

#include "core/closure/effects/observation_effect.h"

namespace core::closure {

[[nodiscard]] ObservationEffect rotor_line_effect();

// Roll, pitch and yaw, px per rad, 2 points x 3. Complete if the readout gives rows different phases; otherwise without
// their constant parts, which a translation absorbs.
[[nodiscard]] Eigen::MatrixXd rotor_fields(const PointGeometry& geometry, double readout_frames);

}  // namespace core::closure
