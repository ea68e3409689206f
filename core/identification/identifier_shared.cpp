// Modes of a structure under gusts that move the camera, too.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/identification/identifier.h"
#include "core/identification/listed_modes.h"
#include "core/identification/measured_inputs.h"
#include "core/identification/relative_motion.h"
#include "core/identification/verdict_words.h"
#include "core/spectrum/select_channels.h"
#include "core/types/witness.h"

namespace core {

namespace {

constexpr double kSameFrequency = 0.02;  // relative

bool is_same(double a_hz, double b_hz) { return std::abs(a_hz - b_hz) < kSameFrequency * b_hz; }

template <class T>
void insert_zero(std::vector<T>& values, int at) {
  if (!values.empty()) values.insert(values.begin() + at, T{});
}

// Channels of the motion relative to the base: without the base, and without witnesses of what the base cancels.
std::vector<std::size_t> relative_channels(const std::vector<ChannelInfo>& channels) {
  std::vector<std::size_t> out;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (!channels[c].is_base && (!channels[c].is_witness || witnesses_turn(channels[c]))) out.push_back(c);
  }
  return out;
}

// A mode of the relative motion replaces the one of the same frequency, and is taken where the camera shares it. A
// shared mode that the relative motion does not have is the camera's.
template <class IsShared>
void prefer_relative(std::vector<Mode> relative, const IsShared& is_shared, int base, ModalEstimate& estimate) {
  std::vector<ListedMode> structural,
      rejected = listed_modes(estimate.rejected, static_cast<int>(estimate.modes.size()));
  std::vector<double> taken_hz;
  for (Mode& mode : relative) {
    const auto is_this = [&](const Mode& one) { return is_same(one.frequency_hz, mode.frequency_hz); };
    if (!is_shared(mode) && std::none_of(estimate.modes.begin(), estimate.modes.end(), is_this)) continue;
    insert_zero(mode.shape, base), insert_zero(mode.shape_std, base);
    mode.reason += "; relative to the base, because the camera moves with the structure";
    taken_hz.push_back(mode.frequency_hz);
    structural.push_back({std::move(mode), -1});
  }
  for (ListedMode& one : listed_modes(estimate.modes, 0)) {
    const auto is_this = [&](double hz) { return is_same(hz, one.mode.frequency_hz); };
    if (!is_shared(one.mode) && std::none_of(taken_hz.begin(), taken_hz.end(), is_this)) {
      structural.push_back(std::move(one));
      continue;
    }
    set(one.mode, Verdict::kInputPeak,
        "the camera moves with the structure: the modes here are those of the motion relative to the base");
    rejected.push_back(std::move(one));
  }
  list_again(std::move(structural), std::move(rejected), estimate);
}

}  // namespace

void Identifier::identify_shared(const CpsdSums& sums, const std::vector<ChannelRecord>& records,
                                 ModalEstimate& estimate) const {
  const auto is_base = [](const ChannelInfo& channel) { return channel.is_base; };
  const auto is_region_at_rest = [](const ChannelInfo& c) { return c.is_witness && !witnesses_turn(c); };
  const auto is_displacement = [](const ChannelInfo& channel) { return channel.n_integrations == 0; };
  if (estimate.poles.empty() || std::count_if(channels_.begin(), channels_.end(), is_base) != 1) return;
  if (!std::all_of(channels_.begin(), channels_.end(), is_displacement)) return;
  if (std::none_of(channels_.begin(), channels_.end(), is_region_at_rest)) return;
  const auto base = static_cast<int>(std::find_if(channels_.begin(), channels_.end(), is_base) - channels_.begin());
  if (measured_inputs(sums, channels_).empty()) return;
  const CpsdSums relative = relative_to_base(sums, delays_as_undone(), base);
  const SharedMotion shared(sums, relative, channels_, base);
  if (!shared.anywhere()) return;

  const std::vector<std::size_t> kept = relative_channels(channels_);
  std::vector<ChannelRecord> kept_records;
  kept_records.reserve(kept.size());
  for (const std::size_t c : kept) kept_records.push_back(records[c]);
  ModalEstimate of_relative;
  with_channels(kept).identify_modes(select_channels(relative, kept), kept_records, nullptr, of_relative);
  if (of_relative.poles.empty()) return;

  const auto is_shared = [&](const Mode& mode) { return shared.at(mode.apparent_hz); };
  const bool any_shared = std::any_of(estimate.modes.begin(), estimate.modes.end(), is_shared) ||
                          std::any_of(of_relative.modes.begin(), of_relative.modes.end(), is_shared);
  if (any_shared) prefer_relative(std::move(of_relative.modes), is_shared, base, estimate);
}

}  // namespace core
