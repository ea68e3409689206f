#pragma once

#include <string>

#include "core/types/health.h"

namespace drivers {

// What the computer says of itself, from /proc and /sys below `root`, and the space left where `disk_path` lies.
// What it does not say stays unknown (NaN, -1). Hottest thermal zone; mean frequency of the CPUs. Throttled: the
// firmware of a Raspberry Pi says so (under-voltage, capped, throttled, soft limit), or a cooling device that slows
// the CPU is at work. Reads a few small files: not for a real-time thread.
[[nodiscard]] core::HostHealth read_host_status(const std::string& disk_path, const std::string& root = "");

}  // namespace drivers
