#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "core/types/health.h"

namespace drivers {

// State of the computer, from /proc and /sys below `root`, and the free space of the disk that contains `disk_path`.
// Unavailable values stay unknown (NaN, -1). Hottest thermal zone; mean frequency of the CPUs. Throttled: reported by
// the firmware of a Raspberry Pi (under-voltage, capped, throttled, soft limit), or a cooling device that slows
// the CPU is active. Reads a few small files: not for a real-time thread.
[[nodiscard]] core::HostHealth read_host_status(const std::string& disk_path, const std::string& root = "");

// What the computer has; -1: unknown.
struct HostCapacity {
  std::int64_t memory_bytes = -1;
  std::int64_t disk_bytes = -1;  // file system that contains `disk_path`
};
[[nodiscard]] HostCapacity read_host_capacity(const std::string& disk_path, const std::string& root = "");

// How busy the processors are, from /proc/stat below `root`.
class ProcessorLoad {
 public:
  explicit ProcessorLoad(std::string root = "") : root_(std::move(root)) {}
  // Share of the time since the last call in which they worked, all together, 0..1; NaN at the first call, or unknown.
  [[nodiscard]] double next();

 private:
  std::string root_;
  std::int64_t worked_ = -1, all_ = -1;  // ticks
};

}  // namespace drivers
