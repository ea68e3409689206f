#include "firmware_app/service/progress.h"

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <ctime>
#include <optional>

#include "firmware_app/config/region_axis.h"
#include "firmware_app/report/estimate_words.h"
#include "firmware_app/report/recording_words.h"
#include "rt/clock.h"

namespace app {

namespace {

constexpr std::int64_t kLinePeriodNs = 5'000'000'000;
constexpr timespec kPace{0, 50'000'000};

void print_mode(const core::Mode& mode, const std::vector<core::ChannelInfo>& channels,
                const std::vector<core::ChannelRecord>& records) {
  std::string shape;
  for (std::size_t c = 0; c < channels.size() && c < mode.shape.size(); ++c) {
    const bool known = c >= records.size() || records[c].takes_part;
    shape += known ? fmt::format(" {}={:+.2f}", channels[c].name, mode.shape[c].real())
                   : fmt::format(" {}=?", channels[c].name);
  }
  const std::string fold = (mode.fold_n.value_or(0) != 0 ? fmt::format(" (seen at {:.3f} Hz)", mode.apparent_hz) : "") +
                           other_frequencies_text(mode);
  const auto sigma = [](const std::optional<double>& value, double factor, int n_decimals) {
    return value ? fmt::format(" ± {:.{}f}", factor * *value, n_decimals) : std::string();
  };
  spdlog::info("  {:9.4f}{} Hz{}  damping {:5.2f}{} %  MPC {:.3f} {}", mode.frequency_hz,
               sigma(mode.frequency_std_hz, 1.0, 4), fold, 100.0 * mode.damping_ratio,
               sigma(mode.damping_std, 100.0, 2), mode.mpc, shape);
}

double milliseconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-6; }

void print_stop(const Pipeline::Outcome& outcome, std::int64_t stop_ns) {
  std::uint64_t longest_ns = 0;
  for (const core::StageHealth& stage : outcome.health.stages) longest_ns = std::max(longest_ns, stage.step.max_ns);
  spdlog::info(
      "stages stopped {:.0f} ms after the request, the report was complete after {:.0f} ms; longest step {:.0f} ms",
      std::max(0.0, milliseconds(outcome.stages_ended_ns - stop_ns)), milliseconds(rt::monotonic_ns() - stop_ns),
      milliseconds(static_cast<std::int64_t>(longest_ns)));
}

}  // namespace

SignalWatch::SignalWatch() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaddset(&signals_, SIGHUP);  // a dropped session; ignored under nohup
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);  // a full quota is then a failed write and does not terminate the process
  std::signal(SIGPIPE, SIG_IGN);
}

bool SignalWatch::stop_requested() const noexcept { return sigtimedwait(&signals_, nullptr, &kPace) > 0; }

Progress::Progress(Pipeline& pipeline)
    : pipeline_(pipeline), start_ns_(rt::monotonic_ns()), next_line_ns_(start_ns_ + kLinePeriodNs) {
  const core::CameraInfo& info = pipeline.camera_info();
  spdlog::info("{}: {} x {} px, {:g} fps, readout {:g} ms", info.description, info.width_px, info.height_px,
               info.rate_hz, static_cast<double>(info.readout_ns) * 1e-6);
  const core::RecordingTimes times = pipeline.health().times;
  if (times.known()) spdlog::info("{}", recording_words(times));
  if (const std::string words = found_axes_words(pipeline.config()); !words.empty()) spdlog::info("{}", words);
  for (const core::ChannelInfo& channel : pipeline.channels()) {
    spdlog::info("channel {}{}: seen {:.2f} ms after row 0", channel.name, channel.is_base ? " (base)" : "",
                 1e3 * channel.row_delay_s);
  }
}

void Progress::started() {
  told_ = pipeline_.warnings();
  for (const std::string& warning : told_) spdlog::warn("{}", warning);
}

void Progress::stopping() {
  if (stop_ns_ == 0) stop_ns_ = rt::monotonic_ns();
}

void Progress::print_stall() {
  const std::string stall = pipeline_.stall();
  if (stall.empty() == !stalled_) return;
  stalled_ = !stall.empty();
  if (stalled_) {
    spdlog::error("stalled: {}", stall);
  } else {
    spdlog::info("all stages run again");
  }
}

void Progress::tick() {
  for (const std::string& line : pipeline_.take_events()) spdlog::info("{}", line);
  print_stall();
  const std::int64_t now_ns = rt::monotonic_ns();
  if (now_ns < next_line_ns_) return;
  next_line_ns_ = now_ns + kLinePeriodNs;
  const core::Health health = pipeline_.health();
  const std::uint64_t total = pipeline_.camera_info().frame_count;
  const double elapsed_s = static_cast<double>(now_ns - start_ns_) * 1e-9;
  if (total > 0 && health.frames_processed + health.frames_dropped >= total) {
    spdlog::info("all {} frames are processed; last estimate, diagnosis and report are being made, {:.0f} s so far",
                 total, elapsed_s);
    return;
  }
  const auto processed = static_cast<double>(health.frames_processed);
  const std::string share =
      total > 0 && processed > 0.0
          ? fmt::format(" of {} ({:.0f} %, {:.0f} s left)", total, 100.0 * processed / static_cast<double>(total),
                        elapsed_s * (static_cast<double>(total) - processed) / processed)
          : "";
  spdlog::info("frame {}{}, {:.1f} s of stream, {} of {} points, {} dropped, {} masked, {} estimates",
               health.frames_processed, share, static_cast<double>(health.t_stream_ns) * 1e-9, health.points_tracked,
               health.points_total, health.frames_dropped, health.samples_masked, health.estimates);
}

bool Progress::finish(const Pipeline::Outcome& outcome) {
  const core::Health& h = outcome.health;
  const double elapsed_s = static_cast<double>(rt::monotonic_ns() - start_ns_) * 1e-9;
  spdlog::info(
      "{} frames in = {} processed + {} dropped; {} missing at the source, {} channel samples masked; {:.1f} s, {:.1f} "
      "frames/s",
      h.frames_in, h.frames_processed, h.frames_dropped, h.frames_missing, h.samples_masked, elapsed_s,
      static_cast<double>(h.frames_processed) / elapsed_s);
  if (h.times.known()) spdlog::info("{}", recording_words(h.times));
  for (const std::string& line : pipeline_.take_events()) spdlog::info("{}", line);
  if (stop_ns_ != 0) print_stop(outcome, stop_ns_);
  for (const std::string& warning : h.warnings) {
    if (std::find(told_.begin(), told_.end(), warning) == told_.end()) spdlog::warn("{}", warning);
  }
  if (h.messages_failed > 0) {
    spdlog::warn(
        "{} telemetry messages failed, {} were sent: check the route of telemetry.lcm_url and the disk under "
        "telemetry.log_file",
        h.messages_failed, h.messages_sent);
  }
  if (outcome.leaves_out)
    spdlog::warn(
        "an estimate, or a report of residual diagnosis or of the declared structure, that did not end in time is left "
        "out");
  for (const std::string& note : outcome.notes) spdlog::warn("{}", note);
  spdlog::info("{} modes from {:.1f} s ({} segments){}", outcome.estimate.modes.size(), outcome.estimate.duration_s,
               outcome.estimate.n_segments, outcome.estimate.status == "ok" ? "" : ": " + outcome.estimate.status);
  for (const core::Mode& mode : outcome.estimate.modes)
    print_mode(mode, pipeline_.channels(), outcome.estimate.channels);
  for (const std::string& words : estimate_words(outcome.estimate, pipeline_.channels())) spdlog::warn("{}", words);
  if (!outcome.page.empty()) spdlog::info("open {}", outcome.page);
  if (outcome.fault.empty()) return true;
  spdlog::error("{}", outcome.fault);
  return false;
}

}  // namespace app
