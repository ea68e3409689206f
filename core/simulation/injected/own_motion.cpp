#include "core/simulation/injected/own_motion.h"

#include "core/simulation/injected/oscillation.h"
#include "core/simulation/random_stream.h"
#include "core/simulation/scene.h"

namespace core::simulation {

OwnMotion::OwnMotion(const Scene& s)
    : flap_(oscillation(s.flap, s.flap.rms_mm, RandomStream(s.seed, "flap"), s.duration_s)),
      rocking_(oscillation(s.rocking, s.rocking.rms_rad, RandomStream(s.seed, "rocking"), s.duration_s)),
      torsion_(oscillation(s.torsion, s.torsion.rms_rad, RandomStream(s.seed, "torsion"), s.duration_s)),
      sway_(oscillation(s.sway, s.sway.rms_mm, RandomStream(s.seed, "sway"), s.duration_s)),
      rocks_(s.rocking.rms_rad > 0.0) {}

}  // namespace core::simulation
