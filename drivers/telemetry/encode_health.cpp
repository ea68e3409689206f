#include <algorithm>

#include "drivers/telemetry/encode.h"

namespace drivers {
namespace {

std::int64_t counter(std::uint64_t value) noexcept { return static_cast<std::int64_t>(value); }

hovermodal::stage_t to_message(const core::StageHealth& stage) {
  hovermodal::stage_t out{};
  out.name = clipped(stage.name, kMaxNameBytes);
  out.n_in = counter(stage.n_in);
  out.n_out = counter(stage.n_out);
  out.n_dropped = counter(stage.n_dropped);
  out.busy_ns = counter(stage.busy_ns);
  out.worst_step_ns = counter(stage.step.max_ns);
  out.p50_step_ns = counter(stage.step.p50_ns);
  out.p99_step_ns = counter(stage.step.p99_ns);
  out.p999_step_ns = counter(stage.step.p999_ns);
  out.cpu_ns = counter(stage.cpu_ns);
  out.stalled_ns = stage.stalled_ns;
  out.queue_depth = static_cast<std::int32_t>(stage.queue_depth);
  out.queue_slots = static_cast<std::int32_t>(stage.queue_slots);
  return out;
}

hovermodal::region_t to_message(const core::RegionHealth& region) {
  hovermodal::region_t out{};
  out.name = clipped(region.name, kMaxNameBytes);
  out.state = core::to_string(region.state);
  out.points_tracked = static_cast<std::int32_t>(region.points_tracked);
  out.points_total = static_cast<std::int32_t>(region.points_total);
  out.frames_searching = counter(region.frames_searching);
  out.frames_lost = counter(region.frames_lost);
  return out;
}

hovermodal::host_t to_message(const core::HostHealth& host) {
  hovermodal::host_t out{};
  out.cpu_temperature_c = static_cast<float>(host.cpu_temperature_c);
  out.cpu_frequency_mhz = static_cast<float>(host.cpu_frequency_mhz);
  out.throttled = static_cast<std::int8_t>(host.throttled);
  out.resident_bytes = host.resident_bytes;
  out.available_bytes = host.available_bytes;
  out.disk_left_bytes = host.disk_left_bytes;
  return out;
}

hovermodal::channel_t to_message(const core::ChannelInfo& channel) {
  hovermodal::channel_t out{};
  out.name = clipped(channel.name, kMaxNameBytes);
  out.region = to_int16(channel.region);
  out.direction_u = static_cast<float>(channel.direction_u);
  out.direction_v = static_cast<float>(channel.direction_v);
  out.row_delay_s = channel.row_delay_s;
  out.is_base = channel.is_base ? 1 : 0;
  return out;
}

}  // namespace

std::string clipped(std::string_view text, std::size_t max_bytes) {
  text = text.substr(0, text.find('\0'));
  if (text.size() <= max_bytes) return std::string(text);
  std::size_t end = max_bytes;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return std::string(text.substr(0, end));
}

hovermodal::health_t to_message(const core::Health& health, const std::vector<core::ChannelInfo>& channels,
                                const StreamIdentity& identity) {
  auto out = begin_message<hovermodal::health_t>(identity, health.t_stream_ns);
  out.state = clipped(health.state, kMaxWarningBytes);
  out.rate_hz = health.rate_hz;
  out.frames_in = counter(health.frames_in);
  out.frames_processed = counter(health.frames_processed);
  out.frames_dropped = counter(health.frames_dropped);
  out.frames_missing = counter(health.frames_missing);
  out.points_tracked = counter(health.points_tracked);
  out.points_total = counter(health.points_total);
  out.samples_masked = counter(health.samples_masked);
  out.estimates = counter(health.estimates);
  out.messages_sent = counter(health.messages_sent);
  out.messages_failed = counter(health.messages_failed);
  out.snapshots_skipped = counter(health.snapshots_skipped);
  out.n_latencies = counter(health.frame_latency.n);
  out.p50_latency_ns = counter(health.frame_latency.p50_ns);
  out.p99_latency_ns = counter(health.frame_latency.p99_ns);
  out.p999_latency_ns = counter(health.frame_latency.p999_ns);
  out.worst_latency_ns = counter(health.frame_latency.max_ns);
  out.host = to_message(health.host);
  const std::size_t n_warnings = std::min(health.warnings.size(), kMaxWarnings);
  for (std::size_t i = 0; i < n_warnings; ++i) out.warnings.push_back(clipped(health.warnings[i], kMaxWarningBytes));
  for (const auto& stage : health.stages) out.stages.push_back(to_message(stage));
  for (const auto& region : health.regions) out.regions.push_back(to_message(region));
  for (const auto& channel : channels) out.channels.push_back(to_message(channel));
  out.n_warnings = to_int16(out.warnings.size());
  out.n_stages = to_int16(out.stages.size());
  out.n_regions = to_int16(out.regions.size());
  out.n_channels = to_int16(out.channels.size());
  return out;
}

}  // namespace drivers
