#include "firmware_app/stages/closure_stage.h"

#include <cmath>
#include <exception>
#include <new>
#include <utility>

#include "core/closure/closure_loop.h"
#include "core/closure/observation/observation_level.h"
#include "rt/clock.h"

namespace app {

namespace {
constexpr double kLeastOfLast = 0.5;  // periods: a shorter rest of the run has no report of its own
}

ClosureStage::ClosureStage(rt::RingReader<core::TrackFrame> tracks, ClosureStageConfig config,
                           rt::RingWriter<core::closure::ClosureReport> reports)
    : tracks_(std::move(tracks)), config_(std::move(config)), reports_(std::move(reports)) {}

rt::StepStatus ClosureStage::step() noexcept {
  if (is_due(config_.period_s)) return report(false);
  if (const core::TrackFrame* frame = tracks_.front()) {
    take(*frame);
    tracks_.pop();
    rt::StageStats::add(stats().n_in);
    return rt::StepStatus::kWorked;
  }
  if (!tracks_.finished()) return rt::StepStatus::kIdle;
  const bool is_left = has_frames_ && (!is_reported_ || is_due(kLeastOfLast * config_.period_s));
  return is_left ? report(true) : rt::StepStatus::kFinished;
}

void ClosureStage::take(const core::TrackFrame& frame) noexcept {
  if (!config_.recent.begin_frame(frame.sequence)) return;
  if (!has_frames_) first_unreported_ = frame.sequence;
  has_frames_ = true;
  t_last_ns_ = frame.t_start_ns;
  for (std::size_t i = 0; i < frame.points.size() && i < config_.column_of_point.size(); ++i) {
    const core::TrackPoint& point = frame.points[i];
    const int column = config_.column_of_point[i];
    if (column < 0 || !point.seen || !std::isfinite(point.u_px) || !std::isfinite(point.v_px)) continue;
    config_.recent.place(static_cast<std::size_t>(column), point);
  }
}

bool ClosureStage::is_due(double period_s) const noexcept {
  const std::uint64_t next = config_.recent.last_sequence() + 1;
  return has_frames_ && next > first_unreported_ &&
         static_cast<double>(next - first_unreported_) >= period_s * config_.rate_hz;
}

rt::StepStatus ClosureStage::report(bool final) noexcept {
  core::closure::ClosureReport* slot = reports_.try_claim();
  if (slot == nullptr) return rt::StepStatus::kIdle;
  first_unreported_ = config_.recent.last_sequence() + 1;
  is_reported_ = true;
  try {
    *slot = {};
    slot->number = n_reports_++;
    slot->first_sequence = config_.recent.first_sequence();
    slot->last_sequence = config_.recent.last_sequence();
    slot->t_stream_ns = t_last_ns_;
    slot->duration_s = static_cast<double>(config_.recent.n_frames()) / config_.rate_hz;
    slot->final = final;
    conclude(*slot);
  } catch (const std::exception&) {  // out of memory: this one is lost and counted, the next may succeed
    rt::StageStats::add(stats().n_dropped);
    return rt::StepStatus::kWorked;
  }
  reports_.publish();
  rt::StageStats::add(stats().n_out);
  return rt::StepStatus::kWorked;
}

void ClosureStage::conclude(core::closure::ClosureReport& out) const {
  const std::int64_t begin_ns = rt::monotonic_ns();
  try {
    core::closure::ObservationLevel level(config_.recent.record());
    core::closure::ClosureOptions options;
    options.n_surrogates = core::closure::ObservationLevel::kSurrogates;
    out.result = core::closure::close_loop(level, options);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {  // the record tells nothing: its words say why
    out.refused = e.what();
  }
  out.took_s = 1e-9 * static_cast<double>(rt::monotonic_ns() - begin_ns);
}

}  // namespace app
