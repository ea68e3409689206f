#include "firmware_app/service/health.h"

#include <fmt/core.h>

#include "drivers/host/memory_reserve.h"
#include "rt/clock.h"

namespace app {

namespace {

// Below a twentieth of a frame the error is smaller than that of the tracks, and no warning is given.
constexpr double kJitterWorthAWord = 0.05;

std::uint64_t read(const std::atomic<std::uint64_t>& counter) noexcept {
  return counter.load(std::memory_order_relaxed);
}

core::LatencyHealth latency_health(const rt::LatencyHistogram& histogram) noexcept {
  const auto p = histogram.percentiles();
  return {p.n, p.p50_ns, p.p99_ns, p.p999_ns, p.max_ns};
}

core::StageHealth stage_health(const HealthCollector::Queue& queue, std::int64_t now_ns) {
  const rt::Stage& stage = queue.runner->stage();
  const rt::StageStats& stats = stage.stats();
  core::StageHealth health;
  health.name = std::string(stage.name());
  health.n_in = read(stats.n_in);
  health.n_out = read(stats.n_out);
  health.n_dropped = read(stats.n_dropped);
  health.busy_ns = read(stats.busy_ns);
  health.cpu_ns = read(stats.cpu_ns);
  health.step = latency_health(stats.step);
  health.stalled_ns = queue.runner->stalled_for_ns(now_ns);
  health.queue_slots = static_cast<std::uint32_t>(queue.n_slots);
  if (queue.depth) health.queue_depth = static_cast<std::uint32_t>(queue.depth());
  return health;
}

// Regions that were not measured throughout.
void warn_of_regions(core::Health& health) {
  for (const core::RegionHealth& region : health.regions) {
    if (region.frames_searching + region.frames_lost == 0) continue;
    const bool is_measured = region.state == core::RegionState::kMeasuring;
    health.warnings.push_back(
        fmt::format("region '{}' {}: not measured in {} frames (searched for in {}, lost in {})", region.name,
                    is_measured ? "is measured again" : fmt::format("is {} now", core::to_string(region.state)),
                    region.frames_searching + region.frames_lost, region.frames_searching, region.frames_lost));
  }
}

void warn_of_camera(const drivers::DeviceTrouble& trouble, core::Health& health) {
  if (trouble.is_lost) health.state = "camera lost: searching for it";
  if (trouble.n_interruptions > 0) {
    health.warnings.push_back(
        fmt::format("the camera was lost {} times (unplugged, disconnected or silent)", trouble.n_interruptions));
  }
  if (trouble.n_damaged > 0 && !health.times.known())
    health.warnings.push_back(fmt::format("{} frames from the camera were damaged and not used", trouble.n_damaged));
  if (trouble.has_no_clock) {
    health.warnings.emplace_back(
        "the camera's time stamps do not match any clock of this computer: frames are stamped on "
        "arrival, with a few ms of jitter");
  }
}

void warn_of_recording(const core::RecordingTimes& times, core::Health& health) {
  if (!times.remark.empty()) health.warnings.push_back(times.remark);
  if (times.n_damaged + times.n_after_damage > 0) {
    health.warnings.push_back(
        fmt::format("{} frames of the file did not decode whole and were not used; {} more were "
                    "predicted from them and may be wrong",
                    times.n_damaged, times.n_after_damage));
  }
}

void warn_of_overload(const ThinningSchedule::Change& thinning, core::Health& health) {
  if (thinning.stride <= 1) return;
  health.warnings.push_back(
      fmt::format("overload: only every {}th frame is kept since frame {}, {:.4g} frames/s; spectra and alias "
                  "orders were restarted there",
                  thinning.stride, thinning.first_sequence, health.rate_hz));
}

void warn_of_tracking(const TrackingStage& tracking, core::Health& health) {
  if (const std::uint64_t n = tracking.n_failed_frames(); n > 0) {
    health.warnings.push_back(fmt::format("the tracker failed on {} frames: they have no points", n));
  }
  if (const std::uint32_t n = tracking.n_reseeded(); n > 0) {
    health.warnings.push_back(fmt::format(
        "{} lost points were re-seeded at their original positions; the reference position is unchanged", n));
  }
  if (tracking.camera_given_up()) {
    health.warnings.emplace_back(
        "the points contradict the estimated camera motion: a region declared static (role background or ground) "
        "moves, or the camera vibrates faster than its motion is followed; only the scale is estimated since then");
  }
  if (const std::uint64_t n = tracking.n_previews_lost(); n > 0) {
    health.warnings.push_back(fmt::format("{} preview images were not sent: newer ones replaced them", n));
  }
}

void warn_of_record(const drivers::RunRecorder* recorder, const TrackingStage& tracking, core::Health& health) {
  if (recorder == nullptr) return;
  if (std::string words = recorder->failure(); !words.empty()) health.warnings.push_back(std::move(words));
  if (const std::uint64_t n = tracking.n_records_lost(); n > 0) {
    health.warnings.push_back(
        fmt::format("{} frames are missing in the run record, and a replay lacks them: the disk is too slow", n));
  }
}

void warn_of_attitude(const drivers::AttitudeListener* listener, const TrackingStage& tracking, core::Health& health) {
  const auto counts = listener != nullptr ? listener->counts() : drivers::ListenerCounts{};
  if (counts.undecodable + counts.dropped > 0) {
    health.warnings.push_back(
        fmt::format("camera.attitude_channel: {} messages are not an attitude, {} were dropped because they "
                    "arrived faster than they were used, {} were accepted",
                    counts.undecodable, counts.dropped, counts.received));
  }
  if (tracking.attitude_given_up()) {
    health.warnings.emplace_back(
        "the image motion contradicts the attitude, which is no longer used: is camera.mount_rpy_deg "
        "right, are both on one clock, is camera.attitude_sigma_deg large enough?");
  }
  if (const std::uint64_t n = tracking.n_without_attitude(); n > 0) {
    health.warnings.push_back(
        fmt::format("{} frames have no attitude within 0.25 s ({} frames have one)", n, tracking.n_with_attitude()));
  }
}

void warn_of_aircraft(const drivers::AircraftListener* listener, core::Health& health) {
  if (listener == nullptr) return;
  const drivers::ListenerCounts counts = listener->counts();
  if (counts.received == 0) {
    health.warnings.emplace_back(
        "camera.aircraft_channel: nothing has been received yet; does `hovermodal mavlink` run, with the same LCM URL "
        "and --aircraft-channel?");
  }
  if (counts.undecodable + counts.dropped > 0) {
    health.warnings.push_back(
        fmt::format("camera.aircraft_channel: {} messages are not a state of an aircraft, {} were dropped because they "
                    "arrived faster than they were used, {} were accepted",
                    counts.undecodable, counts.dropped, counts.received));
  }
}

}  // namespace

core::Health HealthCollector::collect(const drivers::Publisher& publisher) const {
  core::Health health;
  const ThinningSchedule::Change thinning = capture_.thinning().newest();
  health.rate_hz = rate_hz_ / thinning.stride;
  health.t_stream_ns = spectrum_.t_stream_ns();
  health.frames_in = read(capture_.stats().n_in);
  health.frames_dropped = read(capture_.stats().n_dropped);
  health.frames_missing = capture_.n_missing();
  health.frames_processed = read(tracking_.stats().n_in);
  health.points_tracked = tracking_.points_tracked();
  health.points_total = tracking_.points_total();
  health.samples_masked = spectrum_.n_masked();
  health.snapshots_skipped = spectrum_.n_skipped();
  health.messages_sent = publisher.messages_sent();
  health.messages_failed = publisher.messages_failed();
  health.frame_latency = latency_health(tracking_.frame_latency());
  const std::string stalled = stall();
  health.state = stalled.empty() ? "running" : "stalled: " + stalled;
  {
    const std::lock_guard lock(warnings_mutex_);
    health.warnings = warnings_;
  }
  if (camera_ != nullptr) {
    health.times = camera_->times();
    warn_of_recording(health.times, health);
    warn_of_camera(camera_->trouble(), health);
  }
  warn_of_overload(thinning, health);
  warn_of_tracking(tracking_, health);
  health.regions = tracking_.regions();
  for (std::size_t r = 0; r < health.regions.size() && r < region_names_.size(); ++r) {
    health.regions[r].name = region_names_[r];
  }
  warn_of_regions(health);
  if (const std::string failure = checkpoint_ != nullptr ? checkpoint_->failure() : ""; !failure.empty()) {
    health.warnings.push_back("the checkpoint could not be kept: " + failure);
  }
  if (drivers::memory_reserve_is_used()) health.warnings.emplace_back(drivers::kMemoryReserveUsed);
  warn_of_record(recorder_, tracking_, health);
  warn_of_attitude(listener_, tracking_, health);
  warn_of_aircraft(aircraft_, health);
  if (const double jitter = spectrum_.worst_jitter_cells(); jitter > kJitterWorthAWord) {
    health.warnings.push_back(
        fmt::format("time stamps deviate by up to {:.2f} of a frame from even spacing; spectra assume even "
                    "spacing",
                    jitter));
  }
  add_stages(health);
  return health;
}

void HealthCollector::add_stages(core::Health& health) const {
  for (const Queue& queue : queues_) {
    health.stages.push_back(stage_health(queue, rt::monotonic_ns()));
    core::StageHealth& stage = health.stages.back();
    if (stage.name == "identification") {
      health.estimates = stage.n_out;
      if (stage.n_dropped > 0) {
        health.warnings.push_back(fmt::format(
            "{} estimates failed for lack of memory; the last one that succeeded is reported", stage.n_dropped));
      }
    }
    if (stage.name == "publish") stage.n_dropped += tracking_.n_records_lost();
    if (stage.name == "closure") stage.n_dropped += tracking_.n_shown_lost();
  }
}

void HealthCollector::warn(std::string warning) {
  const std::lock_guard lock(warnings_mutex_);
  warnings_.push_back(std::move(warning));
}

std::string HealthCollector::stall() const {
  const std::int64_t now_ns = rt::monotonic_ns();
  for (const Queue& queue : queues_) {
    if (const std::int64_t stalled_ns = queue.runner->stalled_for_ns(now_ns); stalled_ns > 0) {
      return fmt::format("stage {}: one step has taken {:.1f} s", queue.runner->stage().name(),
                         static_cast<double>(stalled_ns) * 1e-9);
    }
  }
  return {};
}

}  // namespace app
