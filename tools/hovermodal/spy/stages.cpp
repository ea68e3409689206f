#ifdef HOVERMODAL_WITH_LCM
#include "tools/hovermodal/spy/stages.h"

#include <fmt/format.h>

#include <limits>

#include "tools/hovermodal/spy/text.h"

namespace tools {
namespace {

using drivers::StreamMonitor;
using hovermodal::health_t;
using hovermodal::stage_t;
using Lines = std::vector<std::string>;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

std::string milliseconds(std::int64_t ns) { return ns > 0 ? number(static_cast<double>(ns) * 1e-6, 3) : "-"; }
std::string megabytes(std::int64_t bytes) { return bytes < 0 ? "-" : number(static_cast<double>(bytes) * 1e-6, 0); }

const stage_t* stage_before(const StreamMonitor& monitor, std::size_t i, const std::string& name) {
  const auto& before = monitor.previous_health();
  if (!before || i >= before->stages.size() || before->stages[i].name != name) return nullptr;
  return &before->stages[i];
}

double seconds_between(const StreamMonitor& monitor) {
  const auto& before = monitor.previous_health();
  if (!before) return kUnknown;
  const double seconds = static_cast<double>(monitor.health()->utc_ns - before->utc_ns) * 1e-9;
  return seconds > 0.0 ? seconds : kUnknown;
}

std::string host_line(const health_t& health) {
  const auto& host = health.host;
  const char* throttled = host.throttled < 0   ? "throttling unknown"
                          : host.throttled > 0 ? "THROTTLED"
                                               : "not throttled";
  return fmt::format("CPU {} C  {} MHz  {}   memory {} MB, {} MB to be had   disk {} MB left",
                     number(static_cast<double>(host.cpu_temperature_c), 1),
                     number(static_cast<double>(host.cpu_frequency_mhz), 0), throttled, megabytes(host.resident_bytes),
                     megabytes(host.available_bytes), megabytes(host.disk_left_bytes));
}

std::string stage_line(const StreamMonitor& monitor, std::size_t i) {
  const stage_t& stage = monitor.health()->stages[i];
  const stage_t* before = stage_before(monitor, i, stage.name);
  const double seconds = seconds_between(monitor);
  const double rate = before != nullptr ? static_cast<double>(stage.n_in - before->n_in) / seconds : kUnknown;
  const double cpu =
      before != nullptr ? 100e-9 * static_cast<double>(stage.cpu_ns - before->cpu_ns) / seconds : kUnknown;
  const std::string ring = stage.queue_slots > 0 ? fmt::format("{}/{}", stage.queue_depth, stage.queue_slots) : "-";
  const std::string stalled =
      stage.stalled_ns > 0 ? fmt::format("  STALLED {} s", number(static_cast<double>(stage.stalled_ns) * 1e-9, 1))
                           : "";
  return fmt::format("{} {:>8} {:>9} {:>8} {:>9} {:>9} {:>9} {:>9} {:>9} {:>6}{}", fit(stage.name, 14), number(rate, 1),
                     stage.n_in, stage.n_dropped, ring, milliseconds(stage.p50_step_ns),
                     milliseconds(stage.p99_step_ns), milliseconds(stage.p999_step_ns),
                     milliseconds(stage.worst_step_ns), number(cpu, 1), stalled);
}

Lines health_lines(const StreamMonitor& monitor) {
  const health_t& h = *monitor.health();
  Lines out{fmt::format("hovermodal inspect  stream {}  {}", printable(monitor.stream_id()), printable(h.state)),
            host_line(h),
            fmt::format("frames {} in, {} processed, {} dropped, {} missing at the source; {} Hz", h.frames_in,
                        h.frames_processed, h.frames_dropped, h.frames_missing, number(h.rate_hz, 2)),
            fmt::format("frame to displacement, ms: p50 {}  p99 {}  p99.9 {}  worst {}  ({} frames)",
                        milliseconds(h.p50_latency_ns), milliseconds(h.p99_latency_ns), milliseconds(h.p999_latency_ns),
                        milliseconds(h.worst_latency_ns), h.n_latencies),
            "stage              in/s        in  dropped      ring    p50 ms    p99 ms  p99.9 ms  worst ms  CPU %"};
  for (std::size_t i = 0; i < h.stages.size(); ++i) out.push_back(stage_line(monitor, i));
  for (const std::string& warning : h.warnings) out.push_back("WARNING " + printable(warning));
  return out;
}

}  // namespace

Lines render_stages(const StreamMonitor& monitor, const ViewOptions& options) {
  Lines lines{"hovermodal inspect   waiting for the first status message"};
  if (monitor.health()) lines = health_lines(monitor);
  for (const std::string& line : render_versions(monitor, options)) lines.push_back(line);
  if (lines.size() > options.rows) lines.resize(options.rows);
  for (std::string& line : lines) {
    line = fit(line, options.columns);
    line.erase(line.find_last_not_of(' ') + 1);
  }
  return lines;
}

}  // namespace tools
#endif
