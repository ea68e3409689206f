#pragma once

#include <string>

#include "drivers/telemetry/stream_monitor.h"

namespace tools {

// True if a final health message was received and every channel delivered exactly the messages that it states as sent,
// in order. Messages withheld by the service do not count as sent.
[[nodiscard]] bool is_complete(const drivers::StreamMonitor& monitor);

// Received messages as JSON: per LCM channel received, sent and held_back (by the last health; null = unknown),
// first_sequence, last_sequence, gaps, out_of_order, restarts, undecodable, foreign, bytes; and final_health, state,
// complete, other_versions (in words), senders (runs that use the stream_id at once), other_senders
// (messages of each run that is not followed).
[[nodiscard]] std::string count_json(const drivers::StreamMonitor& monitor);

}  // namespace tools
