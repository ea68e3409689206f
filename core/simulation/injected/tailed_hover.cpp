#include "core/simulation/injected/tailed_hover.h"

#include "core/simulation/camera/drift.h"
#include "core/simulation/random_stream.h"

namespace core::simulation {

TailedHover::TailedHover(const TailedHoverParameters& p, std::uint64_t seed, double duration_s) {
  for (std::size_t i = 0; i < 3; ++i) {
    axis_[i] =
        drift({p.corner_hz[i], p.order[i], kLimit_hz}, p.rms_mm[i], RandomStream(seed, "tailed_hover", i), duration_s);
    axis_[3 + i] = drift({p.turn_corner_hz[i], p.turn_order[i], kLimit_hz}, p.rms_rad[i],
                         RandomStream(seed, "tailed_hover", 3 + i), duration_s);
  }
}

}  // namespace core::simulation
