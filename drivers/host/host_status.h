#pragma once

#include <string>

#include "core/types/health.h"

namespace drivers {

// State of the computer, from /proc and /sys below `root`, and the free space of the disk that contains `disk_path`.
// Unavailable values stay unknown (NaN, -1). Hottest thermal zone; mean frequency of the CPUs. Throttled: reported by
// the firmware of a Raspberry Pi (under-voltage, capped, throttled, soft limit), or a cooling device that slows
// the CPU is active. Reads a few small files: not for a real-time thread.
[[nodiscard]] core::HostHealth read_host_status(const std::string& disk_path, const std::string& root = "");

}  // namespace drivers
