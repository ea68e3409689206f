#include <algorithm>
#include <array>

#include "tools/hovermodal/ground/json_parts.h"

namespace tools {
namespace {

using drivers::StreamMonitor;
using nlohmann::json;

constexpr std::array<const char*, StreamMonitor::kTopics> kTopicNames{"modal",   "displacement", "spectrum", "tracks",
                                                                      "closure", "health",       "preview"};
constexpr double kToMs = 1e-6;

json sent(const StreamMonitor& monitor, const std::string& lcm_channel) {
  if (!monitor.health()) return nullptr;
  for (const auto& count : monitor.health()->counts) {
    if (count.lcm_channel == lcm_channel) return count.n_sent;
  }
  return nullptr;
}

json stages_json(const StreamMonitor& monitor) {
  json out = json::array();
  for (const auto& s : monitor.health()->stages) {
    if (out.size() >= kMostShownChannels) break;
    out.push_back({{"name", s.name},
                   {"in", s.n_in},
                   {"out", s.n_out},
                   {"dropped", s.n_dropped},
                   {"p50_ms", rounded(static_cast<double>(s.p50_step_ns) * kToMs, 3)},
                   {"p99_ms", rounded(static_cast<double>(s.p99_step_ns) * kToMs, 3)},
                   {"worst_ms", rounded(static_cast<double>(s.worst_step_ns) * kToMs, 3)},
                   {"queue", {s.queue_depth, s.queue_slots}}});
  }
  return out;
}

json channels_json(const StreamMonitor& monitor) {
  json out = json::array();
  for (const auto& c : monitor.health()->channels) {
    if (out.size() >= kMostShownChannels) break;
    out.push_back({{"name", c.name},
                   {"region", c.region},
                   {"u", rounded(static_cast<double>(c.direction_u), 4)},
                   {"v", rounded(static_cast<double>(c.direction_v), 4)},
                   {"base", c.is_base != 0}});
  }
  return out;
}

json regions_json(const StreamMonitor& monitor) {
  json out = json::array();
  for (const auto& r : monitor.health()->regions) {
    if (out.size() >= kMostShownChannels) break;
    out.push_back({{"name", r.name},
                   {"state", r.state},
                   {"tracked", r.points_tracked},
                   {"total", r.points_total},
                   {"searching", r.frames_searching},
                   {"lost", r.frames_lost}});
  }
  return out;
}

// Frames per second between the last two statuses; null: unknown.
json measured_rate(const StreamMonitor& monitor) {
  const auto &now = monitor.health(), &before = monitor.previous_health();
  if (!before || now->utc_ns <= before->utc_ns) return nullptr;
  // As doubles, because the difference of numbers from the network may exceed an integer.
  const double seconds = (static_cast<double>(now->utc_ns) - static_cast<double>(before->utc_ns)) * 1e-9;
  return rounded((static_cast<double>(now->frames_processed) - static_cast<double>(before->frames_processed)) / seconds,
                 4);
}

}  // namespace

json link_json(const LiveView& view) {
  const StreamMonitor& m = view.monitor;
  json out{{"stream", m.stream_id()},
           {"run", view.run},
           {"boot", view.boot},
           {"heard", m.last_received_ns() != 0},
           {"finished", m.is_finished()}};
  out["silent_s"] = m.last_received_ns() == 0
                        ? json(nullptr)
                        : rounded(static_cast<double>(view.now_ns - m.last_received_ns()) * 1e-9, 3);
  std::uint64_t foreign = 0;
  for (std::size_t i = 0; i < StreamMonitor::kTopics; ++i) {
    const auto topic = static_cast<StreamMonitor::Topic>(i);
    const auto& c = m.count(topic);
    foreign += c.foreign;
    out["topics"][kTopicNames[i]] = {{"received", c.received}, {"lost", c.gaps},
                                     {"late", c.out_of_order}, {"bad", c.undecodable},
                                     {"restarts", c.restarts}, {"sent", sent(m, m.lcm_channel(topic))}};
  }
  out["foreign"] = foreign;
  out["senders"] = m.senders().n_senders();
  out["warnings"] = m.sender_warnings();
  return out;
}

json health_json(const StreamMonitor& monitor) {
  const auto& h = *monitor.health();
  json out{{"state", h.state},
           {"t_s", rounded(static_cast<double>(h.stream_time_ns) * 1e-9, 9)},
           {"rate_hz", rounded(h.rate_hz)},
           {"measured_hz", measured_rate(monitor)},
           {"frames_in", h.frames_in},
           {"frames_processed", h.frames_processed},
           {"frames_dropped", h.frames_dropped},
           {"frames_missing", h.frames_missing},
           {"points", {h.points_tracked, h.points_total}},
           {"samples_masked", h.samples_masked},
           {"estimates", h.estimates},
           {"messages_sent", h.messages_sent},
           {"messages_failed", h.messages_failed},
           {"snapshots_skipped", h.snapshots_skipped},
           {"warnings", h.warnings}};
  const auto ms = [](std::int64_t ns) { return rounded(static_cast<double>(ns) * kToMs, 3); };
  if (h.n_latencies > 0) {
    out["latency_ms"] = {ms(h.p50_latency_ns), ms(h.p99_latency_ns), ms(h.p999_latency_ns), ms(h.worst_latency_ns)};
  } else {
    out["latency_ms"] = nullptr;
  }
  const auto known = [](std::int64_t value) { return value < 0 ? json(nullptr) : json(value); };
  out["host"] = {{"cpu_c", rounded(static_cast<double>(h.host.cpu_temperature_c), 3)},
                 {"cpu_mhz", rounded(static_cast<double>(h.host.cpu_frequency_mhz), 4)},
                 {"throttled", known(h.host.throttled)},
                 {"resident_bytes", known(h.host.resident_bytes)},
                 {"available_bytes", known(h.host.available_bytes)},
                 {"disk_left_bytes", known(h.host.disk_left_bytes)}};
  out["stages"] = stages_json(monitor);
  out["regions"] = regions_json(monitor);
  out["channels"] = channels_json(monitor);
  return out;
}

}  // namespace tools
