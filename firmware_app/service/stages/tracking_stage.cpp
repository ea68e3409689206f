#include "firmware_app/service/stages/tracking_stage.h"

#include <utility>

#include "firmware_app/chain/rebuild.h"
#include "rt/clock.h"

namespace app {

namespace {
constexpr std::uint64_t kPostponed = 32;  // frames, about a second

void add(std::atomic<std::uint64_t>& count) noexcept {
  count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}
}  // namespace

TrackingStage::TrackingStage(Ends ends, Calls calls, bool lossless, const CorrectionSwitch& first_change)
    : ends_(std::move(ends)),
      calls_(calls),
      decision_(first_change),
      lossless_(lossless),
      regions_(calls.tracker.regions().n_regions()) {
  for (std::size_t r = 0; r < regions_.size(); ++r) regions_[r].points_total = calls_.tracker.regions().n_points(r);
  scratch_.tracks.points.resize(calls_.tracker.n_points());
  scratch_.sample = calls_.meter.channels().sample_prototype();
}

rt::StepStatus TrackingStage::step() noexcept {
  const core::Frame* frame = ends_.frames.front();
  if (frame == nullptr) return ends_.frames.finished() ? rt::StepStatus::kFinished : rt::StepStatus::kIdle;
  const bool waits = waits_.load(std::memory_order_relaxed);
  if (ends_.changes && !is_decided(frame->sequence) && waits) return rt::StepStatus::kIdle;
  core::DisplacementSample* sample = ends_.samples.try_claim();
  FrameRecord* record = ends_.records.try_claim();
  ShownFrame* shown = ends_.tracks ? ends_.tracks->try_claim() : nullptr;
  const bool is_full = sample == nullptr || record == nullptr || (ends_.tracks && shown == nullptr && waits);
  if (lossless_ && is_full) return rt::StepStatus::kIdle;
  if (!is_rebuilt(frame->sequence)) return rt::StepStatus::kIdle;

  const std::int64_t t_taken_ns = frame->t_taken_ns;
  measure(*frame);
  show_preview(*frame);
  ends_.frames.pop();
  rt::StageStats::add(stats().n_in);
  hand_over(sample, record);
  if (sample != nullptr && t_taken_ns != 0) frame_latency_.add(rt::monotonic_ns() - t_taken_ns);
  if (ends_.tracks) show(shown);
  return rt::StepStatus::kWorked;
}

void TrackingStage::hand_over(core::DisplacementSample* sample, FrameRecord* record) noexcept {
  if (sample != nullptr) {
    *sample = scratch_.sample;  // same sizes: copies values, allocates nothing
    sample->gap_before = sample->gap_before || gap_before_next_;
    ends_.samples.publish();
  }
  rt::StageStats::add(sample != nullptr ? stats().n_out : stats().n_dropped);
  gap_before_next_ = sample == nullptr;
  if (record == nullptr) return add(n_records_lost_);
  *record = scratch_;
  ends_.records.publish();
}

bool TrackingStage::is_decided(std::uint64_t sequence) noexcept {
  while (const CorrectionSwitch* change = ends_.changes->front()) {
    decision_ = *change;
    const bool is_in_time = decision_.from_sequence >= sequence;  // a live source may have passed the frame
    if (decision_.rebuilt != nullptr)
      decision_.rebuilt->announce(is_in_time ? decision_.from_sequence : sequence + kPostponed);
    calls_.meter.take(decision_);
    ends_.changes->pop();
  }
  const bool is_coming = n_shown_through_ > decision_.next_report_at;  // closure has all frames of that report
  const bool is_decided = !is_coming || sequence <= decision_.next_report_at + decision_.n_delay_frames;
  return !lossless_ || is_decided || ends_.changes->finished();
}

// A run measured again is begun where it has all frames before this one. A live source does not wait for it, but names
// a later frame.
bool TrackingStage::is_rebuilt(std::uint64_t sequence) noexcept {
  Rebuild* coming = calls_.meter.coming();
  if (coming == nullptr || !coming->is_due(sequence) || coming->begins_with(sequence)) return true;
  const bool can_wait = lossless_ && waits_.load(std::memory_order_relaxed) && !ends_.changes->finished();
  if (can_wait) {
    coming->wait_for(n_shown_through_);
  } else {
    coming->announce(sequence + kPostponed);
  }
  return !can_wait;
}

void TrackingStage::begin_frame(std::uint64_t sequence) noexcept {
  if (!calls_.meter.begin_frame(sequence)) return;
  events().write("correction {} from frame {} on", calls_.meter.correction_set(), static_cast<std::int64_t>(sequence));
  Takeover* takeover = calls_.meter.rebuilt() != nullptr && ends_.takeovers ? ends_.takeovers->try_claim() : nullptr;
  if (takeover == nullptr) return;  // without one new sums begin
  *takeover = {sequence, calls_.meter.rebuilt()};
  ends_.takeovers->publish();
}

void TrackingStage::show(ShownFrame* slot) noexcept {
  if (slot == nullptr) return add(n_shown_lost_);
  slot->tracks = scratch_.tracks, slot->stride = scratch_.sample.stride;
  if (n_shown_through_ == 0) decision_.next_report_at += scratch_.tracks.sequence;  // the stream's first number
  n_shown_through_ = scratch_.tracks.sequence + 1;
  ends_.tracks->publish();
}

void TrackingStage::show_preview(const core::Frame& frame) noexcept {
  if (!calls_.preview_maker.is_due(frame.t_start_ns)) return;
  calls_.preview_maker.make(frame, scratch_.tracks, ends_.previews.back());
  if (!ends_.previews.publish()) add(n_previews_lost_);
}

void TrackingStage::measure(const core::Frame& frame) noexcept {
  begin_frame(frame.sequence);
  if (!calls_.tracker.track(frame, scratch_.tracks)) add(n_failed_);
  take_attitude();
  take_aircraft(frame.sequence);
  calls_.meter.measure(scratch_.tracks, calls_.thinning.at(frame.sequence).stride, scratch_.sample);
  calls_.tracker.learn(scratch_.tracks);
  count_frame();
  count_attitude();
  count_regions();
}

// Reads only what is in the ring now: a flood of attitudes does not delay a frame.
void TrackingStage::take_attitude() noexcept {
  if (!ends_.attitude) return;
  scratch_.attitude.clear();
  constexpr int kMost = 1024;
  for (int i = 0; i < kMost; ++i) {
    const core::AttitudeSample* sample = ends_.attitude->front();
    if (sample == nullptr) return;
    calls_.meter.take(*sample);
    scratch_.attitude.add(*sample);
    ends_.attitude->pop();
  }
}

// What does not fit waits in the listener's ring, which counts what it drops: spectrum and the record get the same.
void TrackingStage::take_aircraft(std::uint64_t sequence) noexcept {
  scratch_.aircraft.n = 0;
  if (!ends_.aircraft || !ends_.aircraft_updates) return;
  while (scratch_.aircraft.n < core::AircraftBatch::kMost) {
    const core::AircraftState* state = ends_.aircraft->front();
    if (state == nullptr) return;
    AircraftUpdate* update = ends_.aircraft_updates->try_claim();
    if (update == nullptr) return;
    *update = {sequence, *state};
    ends_.aircraft_updates->publish();
    scratch_.aircraft.states[scratch_.aircraft.n++] = *state;
    ends_.aircraft->pop();
  }
}

void TrackingStage::count_frame() noexcept {
  camera_given_up_.store(calls_.meter.channels().camera_given_up(), std::memory_order_relaxed);
  n_reseeded_.store(calls_.tracker.n_reseeded(), std::memory_order_relaxed);
  std::uint64_t n_tracked = 0;
  for (const core::TrackPoint& point : scratch_.tracks.points) n_tracked += point.inlier ? 1U : 0U;
  points_tracked_.store(n_tracked, std::memory_order_relaxed);
}

void TrackingStage::count_attitude() noexcept {
  const core::AttitudePrior* attitude = calls_.meter.channels().attitude();
  if (attitude == nullptr) return;
  attitude_given_up_.store(attitude->given_up(), std::memory_order_relaxed);
  n_with_attitude_.store(attitude->n_used(), std::memory_order_relaxed);
  n_without_attitude_.store(attitude->n_without(), std::memory_order_relaxed);
}

void TrackingStage::count_regions() noexcept {
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    RegionCounts& counts = regions_[r];
    const core::RegionState state = calls_.tracker.regions().state(r);
    counts.state.store(state, std::memory_order_relaxed);
    counts.points_tracked.store(calls_.tracker.regions().n_inliers(r), std::memory_order_relaxed);
    if (state == core::RegionState::kSearching) rt::StageStats::add(counts.frames_searching);
    if (state == core::RegionState::kLost) rt::StageStats::add(counts.frames_lost);
  }
}

std::vector<core::RegionHealth> TrackingStage::regions() const {
  std::vector<core::RegionHealth> out;
  for (const RegionCounts& counts : regions_) {
    out.push_back({"", counts.state.load(std::memory_order_relaxed),
                   counts.points_tracked.load(std::memory_order_relaxed), counts.points_total,
                   counts.frames_searching.load(std::memory_order_relaxed),
                   counts.frames_lost.load(std::memory_order_relaxed)});
  }
  return out;
}

void TrackingStage::finish() noexcept {
  ends_.samples.close();
  ends_.records.close();
  if (ends_.aircraft_updates) ends_.aircraft_updates->close();
  if (ends_.takeovers) ends_.takeovers->close();
  if (ends_.tracks) ends_.tracks->close();
}

}  // namespace app
