#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "drivers/telemetry/stream_monitor.h"

namespace tools {

// What the page is told. Bounded whatever the messages hold: the page's and the network's memory depend on it.
inline constexpr std::size_t kMostShownModes = 48;
inline constexpr std::size_t kMostShownChannels = 32;
inline constexpr std::size_t kMostShownBins = 512;    // of a spectrum: of more, the largest of every n
inline constexpr std::size_t kMostShownPoints = 500;  // of more, every n-th
inline constexpr double kShownRate_hz = 60.0;         // of a displacement: above it, every n-th sample

struct LiveView {
  const drivers::StreamMonitor& monitor;
  std::int64_t run = 0;               // grows when another run is followed
  std::int64_t run_since_utc_ns = 0;  // sender's clock; what was sent earlier is of a run before
  std::int64_t boot = 0;              // differs between two ground stations; two of them do not share run numbers
  std::int64_t now_ns = 0;            // clock given to StreamMonitor::receive
};

// How far a listener has been told.
struct Shown {
  std::int64_t run = -1, health = -1, estimate_utc_ns = -1, preview = -1, closure_utc_ns = -1, spectrum_utc_ns = -1;
  std::uint64_t n_samples = 0;
};

[[nodiscard]] bool has_news(const LiveView& view, const Shown& shown);

// One line of JSON: `link` always; `health`, `modes`, `spectra`, `preview`, `closure`, `traces` where they are newer
// than `shown`, which is brought up to date. tools/ground/state.js reads it. What is not known is null.
[[nodiscard]] std::string snapshot_json(const LiveView& view, Shown& shown);

}  // namespace tools
