#pragma once

#include <Eigen/Core>

#include "core/closure/observation/effect_candidate.h"

namespace core::closure {

// The objection to a whitened pattern whose amplitude in this band only repeats the model's own motions, or their
// rates: then a lens or readout error is behind it, and nothing that moves by itself. Empty: none.
[[nodiscard]] Objection follows_motion(const FitView& fit, const Eigen::VectorXd& whitened, RungSet band);
// The same with the motions of the regions in which the pattern is zero, most of the amplitude: what goes with the
// structure's modes does not move by itself.
[[nodiscard]] Objection follows_regions(const FitView& fit, const Eigen::VectorXd& whitened, RungSet band);

}  // namespace core::closure
