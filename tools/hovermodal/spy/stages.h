#pragma once

#include <string>
#include <vector>

#include "drivers/telemetry/stream_monitor.h"
#include "tools/hovermodal/spy/view.h"

namespace tools {

// View of the running service, from health_t alone: the computer, the path of a frame, and a line per stage. Rates and
// CPU are averages between the last two status messages. At most `rows` lines of at most `columns` characters.
[[nodiscard]] std::vector<std::string> render_stages(const drivers::StreamMonitor& monitor, const ViewOptions& options);

}  // namespace tools
