#include "firmware_app/chain/state/run_state.h"

#include <fmt/core.h>

#include <cmath>

#include "core/spectrum/merge_sums.h"
#include "firmware_app/chain/state/byte_archive.h"
#include "firmware_app/chain/state/channel_archive.h"

namespace app {

namespace {

constexpr double kMostScaleApart = 0.05, kSameRate = 1e-9;

template <class Archive, class State>
void describe_numbers(Archive& archive, State& state) {
  archive.value(state.config_hash);
  archive.value(state.rate_hz);
  archive.value(state.scale_mm_per_px);
  archive.list(state.boot_id);
  archive.list(state.spectrum);
  archive.list(state.modes);
}

}  // namespace

std::vector<std::uint8_t> to_bytes(const RunState& state) {
  ByteWriter out;
  out.bytes.reserve(state.spectrum.size() + state.modes.size() + 4096);
  out.value(static_cast<std::uint64_t>(state.channels.size()));
  for (const core::ChannelInfo& channel : state.channels) describe_channel(out, channel);
  describe_numbers(out, state);
  return std::move(out.bytes);
}

RunState run_state_of(std::span<const std::uint8_t> bytes) {
  ByteReader in(bytes);
  RunState state;
  state.channels.resize(in.count());
  for (core::ChannelInfo& channel : state.channels) describe_channel(in, channel);
  describe_numbers(in, state);
  return state;
}

std::string why_foreign(const RunState& saved, const RunState& now) {
  if (saved.config_hash != now.config_hash) {
    return fmt::format("its configuration was different ({:016x}, now {:016x})", saved.config_hash, now.config_hash);
  }
  if (!(std::abs(saved.rate_hz - now.rate_hz) <= kSameRate * now.rate_hz)) {
    return fmt::format("its frame rate was {:g} Hz and is now {:g} Hz", saved.rate_hz, now.rate_hz);
  }
  core::RecordSums theirs, ours;
  theirs.channels = saved.channels, ours.channels = now.channels;
  if (std::string reason = core::why_not_addable(ours, theirs); !reason.empty()) return reason;
  if (!(std::abs(saved.scale_mm_per_px / now.scale_mm_per_px - 1.0) <= kMostScaleApart)) {
    return fmt::format("its scale was {:.4g} mm per pixel and is now {:.4g}: another view", saved.scale_mm_per_px,
                       now.scale_mm_per_px);
  }
  return {};
}

}  // namespace app
