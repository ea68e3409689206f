#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "drivers/telemetry/stream_monitor.h"

namespace tools {

// Limits of the data sent to the page, whatever the messages contain: memory of page and network depend on them.
inline constexpr std::size_t kMostShownModes = 48;
inline constexpr std::size_t kMostShownChannels = 32;
inline constexpr std::size_t kMostShownBins = 512;    // of a spectrum; larger ones: the maximum of every n bins
inline constexpr std::size_t kMostShownPoints = 500;  // of more, every n-th is shown
inline constexpr double kShownRate_hz = 60.0;         // of a displacement; above it every n-th sample is shown

struct LiveView {
  const drivers::StreamMonitor& monitor;
  std::int64_t run = 0;               // increases when another run is followed
  std::int64_t run_since_utc_ns = 0;  // sender's clock; earlier messages belong to an earlier run
  std::int64_t boot = 0;              // differs between two ground stations, which do not share run numbers
  std::int64_t now_ns = 0;            // clock given to StreamMonitor::receive
};

// What a listener has received so far.
struct Shown {
  std::int64_t run = -1, health = -1, estimate_utc_ns = -1, preview = -1, closure_utc_ns = -1, structure_utc_ns = -1,
               spectrum_utc_ns = -1;
  std::uint64_t n_samples = 0;
};

[[nodiscard]] bool has_news(const LiveView& view, const Shown& shown);

// One line of JSON: `link` always; `health`, `modes`, `spectra`, `preview`, `closure`, `structure`, `traces` if they
// are newer than `shown`, which is updated. Read by tools/ground/state.js. Unknown values are null.
[[nodiscard]] std::string snapshot_json(const LiveView& view, Shown& shown);

}  // namespace tools
