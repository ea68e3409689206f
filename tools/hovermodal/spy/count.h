#pragma once

#include <string>

#include "drivers/telemetry/stream_monitor.h"

namespace tools {

// True when a final health was heard and every channel brought exactly the messages it says were sent, in order. What
// the service held back was not sent.
[[nodiscard]] bool is_complete(const drivers::StreamMonitor& monitor);

// What was heard, as JSON: per LCM channel received, sent and held_back (by the last health; null = not known),
// first_sequence, last_sequence, gaps, out_of_order, restarts, undecodable, foreign, bytes; and final_health, state,
// complete, other_versions (in words).
[[nodiscard]] std::string count_json(const drivers::StreamMonitor& monitor);

}  // namespace tools
