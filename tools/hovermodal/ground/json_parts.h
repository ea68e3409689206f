#pragma once

#include <nlohmann/json.hpp>

#include "tools/hovermodal/ground/snapshot_json.h"

namespace tools {

// At most so many significant digits; null for values that are not finite.
[[nodiscard]] nlohmann::json rounded(double value, int digits = 5);

// Parts of a snapshot; each requires that its message has been received.
[[nodiscard]] nlohmann::json link_json(const LiveView& view);
[[nodiscard]] nlohmann::json health_json(const drivers::StreamMonitor& monitor);
[[nodiscard]] nlohmann::json modes_json(const drivers::StreamMonitor& monitor);
[[nodiscard]] nlohmann::json spectra_json(const drivers::StreamMonitor& monitor);
[[nodiscard]] nlohmann::json preview_json(const drivers::StreamMonitor& monitor);
[[nodiscard]] nlohmann::json closure_json(const hovermodal::closure_report_t& c);
// The samples still kept, starting with number `first`.
[[nodiscard]] nlohmann::json traces_json(const drivers::StreamMonitor& monitor, std::uint64_t first);

}  // namespace tools
