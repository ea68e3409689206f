#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/types/displacement.h"

namespace app {

// Checkpoint written every state.period_s, so that the next run can resume: the sums, the modes followed, and the
// properties of the view that must agree. Parts may be empty.
struct RunState {
  // Must agree; otherwise the checkpoint is foreign.
  std::uint64_t config_hash = 0;
  double rate_hz = 0.0;
  double scale_mm_per_px = 0.0;
  std::vector<core::ChannelInfo> channels;
  // For comparing stamps: the boot to which their CLOCK_MONOTONIC belongs; empty: stream time of a file.
  std::string boot_id;
  std::vector<std::uint8_t> spectrum, modes;
};

[[nodiscard]] std::vector<std::uint8_t> to_bytes(const RunState& state);

// Throws std::runtime_error: not a checkpoint. (Damage is detected by the file's checksum.)
[[nodiscard]] RunState run_state_of(std::span<const std::uint8_t> bytes);

// Why a run like `now` may not resume from `saved`: another configuration or rate, other channels, another view (row
// delays differ by 0.1 ms, scale by 5 %). Empty: it may.
[[nodiscard]] std::string why_foreign(const RunState& saved, const RunState& now);

}  // namespace app
