#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/types/displacement.h"

namespace app {

// What a run leaves on the disk every state.period_s, so that the next one can go on where it was cut off: the sums,
// the modes followed, and what of the view must agree for that. Parts may be empty.
struct RunState {
  // What must agree, or the state is foreign.
  std::uint64_t config_hash = 0;
  double rate_hz = 0.0;
  double scale_mm_per_px = 0.0;
  std::vector<core::ChannelInfo> channels;
  // Where stamps may be compared: the boot whose CLOCK_MONOTONIC they are on; empty: stream time of a file.
  std::string boot_id;
  std::vector<std::uint8_t> spectrum, modes;
};

[[nodiscard]] std::vector<std::uint8_t> to_bytes(const RunState& state);

// Throws std::runtime_error: bytes that are no state. (Damage is found by the file's checksum.)
[[nodiscard]] RunState run_state_of(std::span<const std::uint8_t> bytes);

// Why `saved` may not be continued by a run that is like `now`: another configuration or rate, other channels, another
// view (row delays 0.1 ms, scale 5 % apart). Empty: it may.
[[nodiscard]] std::string why_foreign(const RunState& saved, const RunState& now);

}  // namespace app
