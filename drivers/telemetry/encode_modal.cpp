#include <algorithm>

#include "drivers/telemetry/encode.h"

namespace drivers {
namespace {

using hovermodal::modal_estimate_t;
using hovermodal::mode_t;

constexpr std::size_t kMaxCorrectionSetBytes = 100;

static_assert(static_cast<int>(core::Verdict::kStructural) == mode_t::STRUCTURAL);
static_assert(static_cast<int>(core::Verdict::kCameraMotion) == mode_t::CAMERA_MOTION);
static_assert(static_cast<int>(core::Verdict::kInputPeak) == mode_t::INPUT_PEAK);
static_assert(static_cast<int>(core::Verdict::kHarmonic) == mode_t::HARMONIC);
static_assert(static_cast<int>(core::Verdict::kAmbiguous) == mode_t::AMBIGUOUS);
static_assert(static_cast<int>(core::Verdict::kNumerical) == mode_t::NUMERICAL);
static_assert(static_cast<int>(core::Verdict::kCandidate) == mode_t::CANDIDATE);

float known(const std::optional<double>& value) { return value ? static_cast<float>(*value) : kUnknown; }

std::int16_t fold_on_wire(const std::optional<int>& fold) {
  if (!fold || *fold <= -mode_t::FOLD_UNKNOWN || *fold >= mode_t::FOLD_UNKNOWN) return mode_t::FOLD_UNKNOWN;
  return static_cast<std::int16_t>(*fold);
}

void set_shape(const core::Mode& mode, mode_t& out) {
  const std::size_t n = std::min(mode.shape.size(), std::size_t{INT16_MAX});
  out.n_shape = static_cast<std::int16_t>(n);
  out.shape_re.resize(n);
  out.shape_im.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    out.shape_re[i] = static_cast<float>(mode.shape[i].real());
    out.shape_im[i] = static_cast<float>(mode.shape[i].imag());
  }
  const bool has_std = mode.shape_std.size() >= n;
  out.n_shape_std = has_std ? out.n_shape : std::int16_t{0};
  out.shape_std.resize(has_std ? n : 0);
  for (std::size_t i = 0; i < out.shape_std.size(); ++i) out.shape_std[i] = static_cast<float>(mode.shape_std[i]);
}

void set_history(const std::optional<core::ModeHistory>& history, mode_t& out) {
  out.first_seen_s = history ? static_cast<float>(history->first_seen_s) : kUnknown;
  out.drift_hz_per_s = known(history ? history->drift_hz_per_s : std::nullopt);
  out.drift_std_hz_per_s = known(history ? history->drift_std_hz_per_s : std::nullopt);
  out.more_s = known(history ? history->more_s : std::nullopt);
  if (!history) return;
  out.track_id = to_int32(history->id);
  out.n_estimates = to_int32(history->n_estimates);
  out.n_fold_changes = to_int16(history->n_fold_changes);
  out.drifts = history->drifts ? 1 : 0;
}

mode_t to_message(const core::Mode& mode, bool is_structural) {
  mode_t out{};
  out.is_structural = is_structural ? 1 : 0;
  out.verdict = static_cast<std::int8_t>(mode.verdict);
  out.frequency_hz = mode.frequency_hz;
  out.frequency_std_hz = known(mode.frequency_std_hz);
  out.apparent_hz = mode.apparent_hz;
  out.fold_n = fold_on_wire(mode.fold_n);
  out.fold_margin = known(mode.fold_margin);
  out.damping_ratio = static_cast<float>(mode.damping_ratio);
  out.damping_std = known(mode.damping_std);
  out.mpc = static_cast<float>(mode.mpc);
  out.presence = static_cast<float>(mode.presence);
  set_shape(mode, out);
  out.reason = clipped(mode.reason, kMaxReasonBytes);
  set_history(mode.history, out);
  return out;
}

modal_estimate_t head(const core::ModalEstimate& estimate, const std::vector<core::ChannelInfo>& channels,
                      const StreamIdentity& identity) {
  auto out = begin_message<modal_estimate_t>(identity, estimate.t_stream_ns);
  out.number = static_cast<std::int64_t>(estimate.number);
  out.n_samples = static_cast<std::int64_t>(estimate.n_samples);
  out.n_segments = static_cast<std::int64_t>(estimate.n_segments);
  out.n_missing = static_cast<std::int64_t>(estimate.n_missing);
  out.rate_hz = estimate.rate_hz;
  out.duration_s = estimate.duration_s;
  out.model_order = estimate.model_order;
  out.is_final = estimate.final ? 1 : 0;
  out.status = clipped(estimate.status, kMaxReasonBytes);
  out.n_structural = to_int16(estimate.modes.size());
  out.n_rejected = to_int16(estimate.rejected.size());
  out.n_amendments = to_int16(estimate.amendments.size());
  for (const std::string& words : estimate.amendments) out.amendments.push_back(clipped(words, kMaxCorrectionSetBytes));
  out.n_channels = to_int16(channels.size());
  for (const auto& channel : channels) out.channel_names.push_back(clipped(channel.name, kMaxNameBytes));
  return out;
}

}  // namespace

std::vector<modal_estimate_t> to_messages(const core::ModalEstimate& estimate,
                                          const std::vector<core::ChannelInfo>& channels,
                                          const StreamIdentity& identity) {
  const modal_estimate_t empty = head(estimate, channels, identity);
  const int empty_bytes = empty.getEncodedSize();
  std::vector<modal_estimate_t> parts{empty};
  int bytes = empty_bytes;
  const auto add = [&](const core::Mode& mode, bool is_structural) {
    mode_t message = to_message(mode, is_structural);
    const int mode_bytes = message._getEncodedSizeNoHash();
    if (parts.back().n_modes > 0 && bytes + mode_bytes > kMaxModalPartBytes) {
      parts.push_back(empty);
      bytes = empty_bytes;
    }
    parts.back().modes.push_back(std::move(message));
    ++parts.back().n_modes;
    bytes += mode_bytes;
  };
  for (const auto& mode : estimate.modes) add(mode, true);
  for (const auto& mode : estimate.rejected) add(mode, false);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts[i].part = to_int16(i);
    parts[i].n_parts = to_int16(parts.size());
  }
  return parts;
}

}  // namespace drivers
