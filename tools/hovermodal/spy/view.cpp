#ifdef HOVERMODAL_WITH_LCM
#include "tools/hovermodal/spy/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace tools {
namespace {

using drivers::kTopicSuffixes;
using drivers::StreamMonitor;
using hovermodal::mode_t;
using Lines = std::vector<std::string>;

constexpr std::size_t kRmsSamples = 256;
constexpr std::size_t kHistoryColumns = 19;
constexpr std::size_t kHalf = 49;  // columns of each of two tables side by side

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }
double real(float value) { return static_cast<double>(value); }

const char* verdict_text(std::int8_t verdict) {
  constexpr std::array<const char*, 6> kTexts{"structural", "camera motion", "input peak",
                                              "harmonic",   "ambiguous",     "numerical"};
  return verdict >= 0 && verdict < 6 ? kTexts[static_cast<std::size_t>(verdict)] : "unknown";
}

std::string fold_text(std::int16_t fold_n) {
  return fold_n == mode_t::FOLD_UNKNOWN ? "-" : fmt::format("{:+d}", fold_n);
}

// "#3   240s  -0.12*": number, record since it was first seen, trend in % a minute; * = significant.
std::string history_text(const mode_t& mode, double duration_s) {
  if (mode.track_id <= 0) return fit("  -", kHistoryColumns);
  const double trend = 6000.0 * real(mode.drift_hz_per_s) / mode.frequency_hz;
  return fmt::format("{} {:>6} {:>6}{}", fit(fmt::format("#{}", mode.track_id), 4),
                     number(duration_s - real(mode.first_seen_s), 0) + "s", number(trend, 2),
                     mode.drifts != 0 ? '*' : ' ');
}

std::string mode_line(const mode_t& mode, double duration_s, const ViewOptions& options) {
  constexpr std::size_t kBeforeShape = 63 + kHistoryColumns + 1;
  const std::size_t shape_columns = options.columns > kBeforeShape ? options.columns - kBeforeShape : 0;
  return fmt::format("{:>9} {:>8} {:>7} {:>6} {:>6} {:>5}  {} {} {}", number(mode.frequency_hz, 4),
                     number(real(mode.frequency_std_hz), 4), number(100.0 * real(mode.damping_ratio), 2),
                     number(100.0 * real(mode.damping_std), 2), number(real(mode.mpc), 3), fold_text(mode.fold_n),
                     fit(verdict_text(mode.verdict), 14), history_text(mode, duration_s),
                     shape_bars(mode.shape_re, mode.shape_im, shape_columns, options.charset));
}

std::string modes_title(const StreamMonitor& monitor) {
  const auto& e = monitor.estimate();
  if (!e) return "MODES  none yet";
  return fmt::format("MODES  estimate {}{} at {} s, {} segments, order {}, {} structural, {} rejected{}: {}", e->number,
                     e->is_final != 0 ? " (final)" : "", number(seconds(e->stream_time_ns), 1), e->n_segments,
                     e->model_order, e->n_structural, e->n_rejected,
                     monitor.parts_heard() < e->n_parts
                         ? fmt::format(", {} of {} parts heard", monitor.parts_heard(), e->n_parts)
                         : "",
                     printable(e->status));
}

Lines head_lines(const StreamMonitor& monitor, const ViewOptions& options) {
  Lines out;
  const auto& h = monitor.health();
  out.push_back(fmt::format("hovermodal spy  stream {}  config {:016x}  {}  heard {} s ago",
                            fit(monitor.stream_id(), 14), static_cast<std::uint64_t>(monitor.config_hash()),
                            h ? fit(h->state, 16) : "no health yet",
                            number(seconds(options.now_ns - monitor.last_received_ns()), 1)));
  if (!h) return out;
  out.push_back(fmt::format("t {} s  rate {} Hz  frames in {}  processed {}  dropped {}  missing {}  masked samples {}",
                            number(seconds(monitor.stream_time_ns()), 2), number(h->rate_hz, 2), h->frames_in,
                            h->frames_processed, h->frames_dropped, h->frames_missing, h->samples_masked));
  out.push_back(fmt::format("points {} / {}  estimates {}  snapshots skipped {}  messages sent {}  failed {}",
                            h->points_tracked, h->points_total, h->estimates, h->snapshots_skipped, h->messages_sent,
                            h->messages_failed));
  std::string unmeasured;
  for (const auto& region : h->regions) {
    if (region.state == "measuring") continue;
    unmeasured += fmt::format("{}{} {} ({}/{} points)", unmeasured.empty() ? "" : ", ", printable(region.name),
                              printable(region.state), region.points_tracked, region.points_total);
  }
  if (!unmeasured.empty()) out.push_back("REGIONS " + unmeasured);
  for (std::size_t i = 0; i < std::min<std::size_t>(h->warnings.size(), 2); ++i) {
    const bool has_more = i == 1 && h->warnings.size() > 2;
    out.push_back("WARNING " + printable(h->warnings[i]) +
                  (has_more ? fmt::format(" (and {} more)", h->warnings.size() - 2) : ""));
  }
  return out;
}

const char* nothing_found(const hovermodal::closure_report_t& c) {
  constexpr double kOfNoise = 1.5;
  return c.residual_after > kOfNoise * c.noise_floor ? "; no known effect explains it" : "; no effect is missing";
}

// "<head>residual 0.0433 -> 0.0312 px, noise 0.0312", then a line for each effect.
Lines finding_lines(const std::string& head, const hovermodal::closure_report_t& c) {
  constexpr std::size_t kMostEffects = 3;
  if (!c.refused.empty()) return {head + printable(c.refused)};
  Lines out{fmt::format("{}residual {} -> {} {}, noise {}{}", head, number(c.residual_before, 4),
                        number(c.residual_after, 4), printable(c.unit), number(c.noise_floor, 4),
                        c.steps.empty() ? nothing_found(c) : "")};
  for (std::size_t i = 0; i < std::min(c.steps.size(), kMostEffects); ++i)
    out.push_back(fmt::format("      {}: {}", printable(c.steps[i].effect), printable(c.steps[i].numbers)));
  if (c.n_adopted > static_cast<int>(out.size()) - 1)
    out.back() += fmt::format(" (and {} more)", c.n_adopted - static_cast<int>(out.size()) + 1);
  return out;
}

Lines closure_lines(const StreamMonitor& monitor) {
  Lines out;
  if (const auto& c = monitor.closure()) {
    out = finding_lines(fmt::format("LOOP  frames {} - {}: ", c->first_frame, c->last_frame), *c);
    for (const std::string& change : c->changes) out.push_back("      " + printable(change));
    if (c->changes.empty())
      for (const std::string& effect : c->in_force) out.push_back("      taken out: " + printable(effect));
  }
  if (const auto& c = monitor.structure()) {
    const Lines more = finding_lines(fmt::format("STRUCTURE  modes of {} s: ", number(c->duration_s, 3)), *c);
    out.insert(out.end(), more.begin(), more.end());
  }
  return out;
}

Lines displacement_lines(const StreamMonitor& monitor, const ViewOptions& options) {
  Lines out{fmt::format("DISPLACEMENT  rms of the last {} samples, mm", kRmsSamples)};
  constexpr std::size_t kRows = 6;
  const std::size_t n = monitor.n_channels();
  for (std::size_t row = 0; row < std::min(n, kRows); ++row) {
    std::string line;
    for (std::size_t i = row; i < std::min(n, 2 * kRows); i += kRows) {
      const auto& history = monitor.history_mm(i);
      line += fmt::format("  {} {:>9} {}", fit(monitor.channel_name(i), 12), number(rms(history, kRmsSamples), 3),
                          sparkline(history, kHalf - 25, options.charset));
    }
    out.push_back(line);
  }
  if (n > 2 * kRows) out.front() += fmt::format("  ({} channels more)", n - 2 * kRows);
  return out;
}

const hovermodal::message_count_t* by_the_sender(const StreamMonitor& monitor, const std::string& lcm_channel) {
  if (!monitor.health()) return nullptr;
  for (const auto& count : monitor.health()->counts) {
    if (count.lcm_channel == lcm_channel) return &count;
  }
  return nullptr;
}

Lines channel_table(const StreamMonitor& monitor) {
  Lines out{"LCM channel   heard   sent   held  gaps  bad"};
  for (std::size_t i = 0; i < StreamMonitor::kTopics; ++i) {
    const auto topic = static_cast<StreamMonitor::Topic>(i);
    const auto& count = monitor.count(topic);
    const std::string& name = monitor.lcm_channel(topic);
    const auto* sender = by_the_sender(monitor, name);
    out.push_back(fmt::format("{} {:>6} {:>6} {:>6} {:>5} {:>4}", fit(kTopicSuffixes[i] + 1, 12), count.received,
                              sender != nullptr ? std::to_string(sender->n_sent) : "-",
                              sender != nullptr ? std::to_string(sender->n_held_back) : "-", count.gaps,
                              count.undecodable + count.foreign + count.out_of_order));
  }
  return out;
}

Lines stage_table(const StreamMonitor& monitor) {
  Lines out{"stage               in     out dropped   queue worst ms"};
  if (!monitor.health()) return out;
  for (const auto& stage : monitor.health()->stages) {
    if (out.size() > 6) break;
    out.push_back(fmt::format("{} {:>7} {:>7} {:>7} {:>7} {:>8}", fit(stage.name, 14), stage.n_in, stage.n_out,
                              stage.n_dropped, fmt::format("{}/{}", stage.queue_depth, stage.queue_slots),
                              number(static_cast<double>(stage.worst_step_ns) * 1e-6, 1)));
  }
  return out;
}

Lines side_by_side(const Lines& left, const Lines& right) {
  Lines out;
  for (std::size_t i = 0; i < std::max(left.size(), right.size()); ++i) {
    out.push_back(fit(i < left.size() ? left[i] : "", kHalf - 4) + (i < right.size() ? right[i] : ""));
  }
  return out;
}

void append(Lines& lines, const Lines& more) { lines.insert(lines.end(), more.begin(), more.end()); }

}  // namespace

Lines render_modes(const StreamMonitor& monitor, const ViewOptions& options, std::size_t max_modes) {
  Lines out{modes_title(monitor)};
  if (!monitor.estimate()) return out;
  out.push_back("     f Hz       +-  zeta %     +-    MPC  fold  verdict        mode    age  %/min  shape per channel");
  const auto modes = monitor.modes();
  for (std::size_t i = 0; i < std::min(modes.size(), max_modes); ++i) {
    out.push_back(mode_line(*modes[i], monitor.estimate()->duration_s, options));
  }
  return out;
}

Lines render_versions(const StreamMonitor& monitor, const ViewOptions& options) {
  Lines out;
  for (const std::string& words : monitor.sender_warnings()) append(out, wrapped("WARNING " + words, options.columns));
  return out;
}

std::string render_status(const StreamMonitor& monitor, const ViewOptions&) {
  std::uint64_t gaps = 0, bad = 0, heard = 0, bytes = 0;
  std::int64_t held_back = 0;
  for (std::size_t i = 0; i < StreamMonitor::kTopics; ++i) {
    const auto topic = static_cast<StreamMonitor::Topic>(i);
    const auto& count = monitor.count(topic);
    gaps += count.gaps;
    bad += count.undecodable;
    heard += count.received;
    bytes += count.n_bytes;
    if (const auto* sender = by_the_sender(monitor, monitor.lcm_channel(topic))) held_back += sender->n_held_back;
  }
  const auto& h = monitor.health();
  return fmt::format(
      "t {} s  {}  frames {} in, {} processed, {} dropped, {} missing; messages {} heard ({} kB), {} lost, {} held "
      "back, {} bad",
      number(seconds(monitor.stream_time_ns()), 2), h ? printable(h->state) : "no health yet", h ? h->frames_in : 0,
      h ? h->frames_processed : 0, h ? h->frames_dropped : 0, h ? h->frames_missing : 0, heard, bytes / 1000, gaps,
      held_back, bad);
}

Lines render_screen(const StreamMonitor& monitor, const ViewOptions& options) {
  Lines lines;
  if (monitor.last_received_ns() == 0)
    lines.push_back("hovermodal spy   waiting for the first message");
  else
    lines = head_lines(monitor, options);
  append(lines, render_versions(monitor, options));
  Lines below = closure_lines(monitor);
  append(below, displacement_lines(monitor, options));
  append(below, side_by_side(channel_table(monitor), stage_table(monitor)));
  const std::size_t used = lines.size() + below.size() + 2;
  append(lines, render_modes(monitor, options, options.rows > used ? options.rows - used : 0));
  append(lines, below);
  if (lines.size() > options.rows) lines.resize(options.rows);
  for (auto& line : lines) {
    line = fit(line, options.columns);
    line.erase(line.find_last_not_of(' ') + 1);
  }
  return lines;
}

}  // namespace tools
#endif
