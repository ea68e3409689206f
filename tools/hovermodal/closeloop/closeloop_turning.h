#pragma once

#include "tools/hovermodal/closeloop/closeloop_series.h"
#include "tools/hovermodal/readout/gyro_clip.h"

namespace tools {

// `closeloop --clip FRAMES --stamps FILE --gyro FILE`: a camera declared as a global shutter without rotation.
// Throws as read_gyro_clip() and core::closure::GyroRotationLevel do.
void close_turning(const LoopRequest& request, const GyroClipOptions& options);

}  // namespace tools
