#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/telemetry/stream_monitor.h"
#include "tools/hovermodal/spy/text.h"

namespace tools {

struct ViewOptions {
  std::size_t columns = 100, rows = 30;
  Charset charset = Charset::kUnicode;
  std::int64_t now_ns = 0;  // in the clock given to StreamMonitor::receive
};

// The whole screen: at most `rows` lines of at most `columns` characters.
[[nodiscard]] std::vector<std::string> render_screen(const drivers::StreamMonitor& monitor, const ViewOptions& options);

// The modes alone: a title, a header, and at most `max_modes` lines.
[[nodiscard]] std::vector<std::string> render_modes(const drivers::StreamMonitor& monitor, const ViewOptions& options,
                                                    std::size_t max_modes);

// Senders of another version, each in as many lines as needed; empty: none.
[[nodiscard]] std::vector<std::string> render_versions(const drivers::StreamMonitor& monitor,
                                                       const ViewOptions& options);

// Time, frames, losses and state in one line, for a log.
[[nodiscard]] std::string render_status(const drivers::StreamMonitor& monitor, const ViewOptions& options);

}  // namespace tools
