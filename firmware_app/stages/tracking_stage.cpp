#include "firmware_app/stages/tracking_stage.h"

#include <utility>

#include "rt/clock.h"

namespace app {

TrackingStage::TrackingStage(rt::RingReader<core::Frame> frames, core::StructureTracker& tracker,
                             core::ChannelDisplacement& channels, core::ReadoutEstimator& readout,
                             rt::RingWriter<core::DisplacementSample> samples, rt::RingWriter<FrameRecord> records,
                             bool lossless, const ThinningSchedule& thinning)
    : frames_(std::move(frames)),
      tracker_(tracker),
      channels_(&channels),
      readout_(&readout),
      samples_(std::move(samples)),
      records_(std::move(records)),
      lossless_(lossless),
      thinning_(thinning),
      regions_(tracker.regions().n_regions()) {
  for (std::size_t r = 0; r < regions_.size(); ++r) regions_[r].points_total = tracker.regions().n_points(r);
  scratch_.tracks.points.resize(tracker.n_points());
  scratch_.sample = channels.sample_prototype();
}

rt::StepStatus TrackingStage::step() noexcept {
  const core::Frame* frame = frames_.front();
  if (frame == nullptr) return frames_.finished() ? rt::StepStatus::kFinished : rt::StepStatus::kIdle;
  if (amendments_ && !follow_amendments(frame->sequence)) return rt::StepStatus::kIdle;
  core::DisplacementSample* sample = samples_.try_claim();
  FrameRecord* record = records_.try_claim();
  core::TrackFrame* shown = shown_ ? shown_->try_claim() : nullptr;
  const bool is_full = sample == nullptr || record == nullptr || (shown_ && shown == nullptr);
  if (lossless_ && is_full) return rt::StepStatus::kIdle;

  const std::int64_t t_taken_ns = frame->t_taken_ns;
  measure(*frame);
  show_preview(*frame);
  frames_.pop();
  rt::StageStats::add(stats().n_in);
  if (sample != nullptr) {
    *sample = scratch_.sample;  // same sizes: copies values, allocates nothing
    sample->gap_before = sample->gap_before || gap_before_next_;
    samples_.publish();
    if (t_taken_ns != 0) frame_latency_.add(rt::monotonic_ns() - t_taken_ns);
    rt::StageStats::add(stats().n_out);
  } else {
    rt::StageStats::add(stats().n_dropped);
  }
  gap_before_next_ = sample == nullptr;
  if (record != nullptr) {
    *record = scratch_;
    records_.publish();
  } else {
    n_records_lost_.store(n_records_lost_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }
  if (shown_) show(shown);
  return rt::StepStatus::kWorked;
}

bool TrackingStage::follow_amendments(std::uint64_t sequence) noexcept {
  while (const ViewChange* change = amendments_->front()) {
    view_ = *change;
    if (view_.geometry != nullptr) pending_ = view_;
    amendments_->pop();
  }
  const bool is_coming = n_shown_through_ > view_.next_report_at;  // all frames of that report were shown
  const bool is_decided = !is_coming || sequence <= view_.next_report_at + view_.n_delay_frames;
  if (lossless_ && !is_decided && !amendments_->finished()) return false;
  if (pending_.geometry == nullptr || sequence < pending_.from_sequence) return true;
  channels_ = &pending_.geometry->displacement;
  readout_ = &pending_.geometry->readout;
  scratch_.sample.amendment = pending_.amendment, scratch_.sample.record = pending_.record;
  events().write("correction {} from frame {} on", pending_.amendment, static_cast<std::int64_t>(sequence));
  pending_ = {};
  return true;
}

void TrackingStage::show(core::TrackFrame* slot) noexcept {
  if (slot == nullptr) {
    n_shown_lost_.store(n_shown_lost_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    return;
  }
  *slot = scratch_.tracks;
  if (n_shown_through_ == 0) view_.next_report_at += scratch_.tracks.sequence;  // the stream begins here
  n_shown_through_ = scratch_.tracks.sequence + 1;
  shown_->publish();
}

void TrackingStage::show_preview(const core::Frame& frame) noexcept {
  if (preview_maker_ == nullptr || !preview_maker_->is_due(frame.t_start_ns)) return;
  preview_maker_->make(frame, scratch_.tracks, previews_->back());
  if (!previews_->publish()) n_previews_lost_.fetch_add(1, std::memory_order_relaxed);
}

void TrackingStage::measure(const core::Frame& frame) noexcept {
  if (!tracker_.track(frame, scratch_.tracks))
    n_failed_.store(n_failed_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  take_attitude();
  channels_->update(scratch_.tracks, scratch_.sample);
  count_attitude();
  // Its filters are made for the camera's own rate; the readout is the same at any.
  if (thinning_.at(frame.sequence).stride == 1) readout_->update(scratch_.tracks);
  scratch_.sample.readout = readout_->estimate();
  tracker_.learn(scratch_.tracks);
  count_regions();
  camera_given_up_.store(channels_->camera_given_up(), std::memory_order_relaxed);
  n_reseeded_.store(tracker_.n_reseeded(), std::memory_order_relaxed);
  std::uint64_t n_tracked = 0;
  for (const core::TrackPoint& point : scratch_.tracks.points) n_tracked += point.inlier ? 1U : 0U;
  points_tracked_.store(n_tracked, std::memory_order_relaxed);
}

// What is in the ring now, and no more: a flood does not hold up a frame.
void TrackingStage::take_attitude() noexcept {
  if (!attitude_) return;
  scratch_.attitude.clear();
  constexpr int kMost = 1024;
  for (int i = 0; i < kMost; ++i) {
    const core::AttitudeSample* sample = attitude_->front();
    if (sample == nullptr) return;
    channels_->take(*sample);
    scratch_.attitude.add(*sample);
    attitude_->pop();
  }
}

void TrackingStage::count_attitude() noexcept {
  const core::AttitudePrior* attitude = channels_->attitude();
  if (attitude == nullptr) return;
  attitude_given_up_.store(attitude->given_up(), std::memory_order_relaxed);
  n_with_attitude_.store(attitude->n_used(), std::memory_order_relaxed);
  n_without_attitude_.store(attitude->n_without(), std::memory_order_relaxed);
}

void TrackingStage::count_regions() noexcept {
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    RegionCounts& counts = regions_[r];
    const core::RegionState state = tracker_.regions().state(r);
    counts.state.store(state, std::memory_order_relaxed);
    counts.points_tracked.store(tracker_.regions().n_inliers(r), std::memory_order_relaxed);
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
  samples_.close();
  records_.close();
  if (shown_) shown_->close();
}

}  // namespace app
