#pragma once

#include <nlohmann/json.hpp>

#include "tools/hovermodal/ground/snapshot_json.h"

namespace tools {

// So many significant digits, no more; null for what is no number.
[[nodiscard]] nlohmann::json rounded(double value, int digits = 5);

// Parts of a snapshot; the message they are made of is there.
[[nodiscard]] nlohmann::json link_json(const LiveView& view);
[[nodiscard]] nlohmann::json health_json(const drivers::StreamMonitor& monitor);
[[nodiscard]] nlohmann::json modes_json(const drivers::StreamMonitor& monitor);
[[nodiscard]] nlohmann::json spectra_json(const drivers::StreamMonitor& monitor);
[[nodiscard]] nlohmann::json preview_json(const drivers::StreamMonitor& monitor);
[[nodiscard]] nlohmann::json closure_json(const drivers::StreamMonitor& monitor);
// The samples from number `first` on that are still kept.
[[nodiscard]] nlohmann::json traces_json(const drivers::StreamMonitor& monitor, std::uint64_t first);

}  // namespace tools
