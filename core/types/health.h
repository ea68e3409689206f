#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/types/recording_times.h"
#include "core/types/region.h"

namespace core {

// A distribution of durations since start; a percentile is at most 1/16 too long.
struct LatencyHealth {
  std::uint64_t n = 0;  // 0: nothing measured, all others 0
  std::uint64_t p50_ns = 0, p99_ns = 0, p999_ns = 0, max_ns = 0;
};

// Counters of one stage since start. Latencies in nanoseconds from step begin to step end.
struct StageHealth {
  std::string name;
  std::uint64_t n_in = 0;       // items taken
  std::uint64_t n_out = 0;      // items handed on
  std::uint64_t n_dropped = 0;  // items lost here
  std::uint64_t busy_ns = 0;
  std::uint64_t cpu_ns = 0;  // processor time of its thread
  LatencyHealth step;
  std::int64_t stalled_ns = 0;                     // time in the current step beyond the permitted one; else 0
  std::uint32_t queue_depth = 0, queue_slots = 0;  // of its input ring
};

// A region, since start.
struct RegionHealth {
  std::string name;
  RegionState state = RegionState::kMeasuring;         // in the newest frame
  std::uint64_t points_tracked = 0, points_total = 0;  // in the newest frame; inliers
  std::uint64_t frames_searching = 0, frames_lost = 0;
};

// State of the computer. NaN and -1: not available.
struct HostHealth {
  double cpu_temperature_c = std::numeric_limits<double>::quiet_NaN();
  double cpu_frequency_mhz = std::numeric_limits<double>::quiet_NaN();
  int throttled = -1;                 // 1 = slowed by heat or voltage
  std::int64_t resident_bytes = -1;   // of this process
  std::int64_t available_bytes = -1;  // memory that is still available
  std::int64_t disk_left_bytes = -1;  // on the file system of the report
};

// State of the whole service, once a second and at the end. Every loss has a counter here.
struct Health {
  std::int64_t t_stream_ns = 0;  // stream time of the newest frame
  double rate_hz = 0.0;          // nominal
  std::uint64_t frames_in = 0;   // frames_in = frames_processed + frames_dropped at the end of a run, exactly
  std::uint64_t frames_processed = 0;
  std::uint64_t frames_dropped = 0;                    // full ring
  std::uint64_t frames_missing = 0;                    // lost before the service: gaps of the source's sequence numbers
  std::uint64_t points_tracked = 0, points_total = 0;  // of the newest frame
  std::uint64_t samples_masked = 0;                    // channel samples without a value
  std::uint64_t estimates = 0;
  std::uint64_t messages_sent = 0, messages_failed = 0;
  std::uint64_t snapshots_skipped = 0;  // due, but the previous one was not yet processed (live sources only)
  LatencyHealth frame_latency;          // from the arrival of a frame to the output of its displacement
  std::string state;                    // "starting", "running", "stalled: ...", "finished", "fault: ..."
  std::vector<std::string> warnings;    // e.g. real-time priority refused
  std::vector<StageHealth> stages;
  HostHealth host;
  std::vector<RegionHealth> regions;  // empty if frames are not tracked here
  RecordingTimes times;               // of a recording that is read here
};

}  // namespace core
