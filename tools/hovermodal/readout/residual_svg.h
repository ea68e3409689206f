#pragma once

#include <string>

#include "core/geometry/gyro_readout.h"
#include "tools/hovermodal/readout/clip_motion.h"

namespace tools {

// Residual between the gyro's and the picture's motion per frame pair, without and with the readout time.
[[nodiscard]] std::string residual_svg(const ClipMotion& clip, const core::GyroReadout& found);

}  // namespace tools
