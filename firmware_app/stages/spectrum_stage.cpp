#include "firmware_app/stages/spectrum_stage.h"

#include <algorithm>

namespace app {

SpectrumStage::SpectrumStage(rt::RingReader<core::DisplacementSample> samples, const core::WelchConfig& config,
                             int period_hops, rt::TripleBuffer<SpectrumSnapshot>& snapshots, bool lossless)
    : samples_(samples),
      grid_(config.rate_hz),
      welch_(config),
      period_hops_(static_cast<std::uint64_t>(std::max(1, period_hops))),
      snapshots_(snapshots),
      lossless_(lossless) {}

rt::StepStatus SpectrumStage::step() noexcept {
  if (due_) return hand_over();
  if (n_to_mask_ > 0) {
    note_hop(mask_one_missing());
    return rt::StepStatus::kWorked;
  }
  const core::DisplacementSample* sample = samples_.front();
  if (sample == nullptr) return samples_.finished() ? end_record() : rt::StepStatus::kIdle;
  if (!front_placed_) {
    const core::TimeGrid::Placement placement = grid_.place(sample->t_start_ns);
    front_placed_ = true;
    front_refused_ = !placement.accepted;
    worst_jitter_cells_.store(grid_.worst_jitter_cells(), std::memory_order_relaxed);
    // After a gap of more than two segments nothing of the old samples is left in the segment being gathered: more
    // masked cells would only add empty segments.
    n_to_mask_ =
        std::min<std::uint64_t>(placement.n_missing_before, 2 * static_cast<std::uint64_t>(welch_.sums().n_fft));
    if (n_to_mask_ > 0) return rt::StepStatus::kWorked;
  }
  take(*sample);
  samples_.pop();
  front_placed_ = false;
  rt::StageStats::add(stats().n_in);
  return rt::StepStatus::kWorked;
}

void SpectrumStage::take(const core::DisplacementSample& sample) noexcept {
  if (front_refused_) {
    rt::StageStats::add(stats().n_dropped);
    return;
  }
  t_stream_ns_.store(sample.t_start_ns, std::memory_order_relaxed);
  readout_ = sample.readout;
  note_hop(welch_.push(sample.value_mm, sample.seen));
}

bool SpectrumStage::mask_one_missing() noexcept {
  --n_to_mask_;
  return welch_.push_missing();
}

void SpectrumStage::note_hop(bool hop) noexcept {
  n_masked_.store(welch_.sums().n_missing, std::memory_order_relaxed);
  due_ = hop && welch_.n_hops() % period_hops_ == 0;
}

rt::StepStatus SpectrumStage::end_record() noexcept {
  if (flushed_) return rt::StepStatus::kFinished;
  welch_.flush();
  flushed_ = true;
  due_ = true;
  return rt::StepStatus::kWorked;
}

rt::StepStatus SpectrumStage::hand_over() noexcept {
  if (!snapshots_.taken()) {
    if (lossless_ || flushed_) return rt::StepStatus::kIdle;  // the last one is never skipped
    n_skipped_.store(n_skipped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }
  SpectrumSnapshot& snapshot = snapshots_.back();
  snapshot.sums = welch_.sums();  // same sizes: copies values, allocates nothing
  snapshot.number = n_snapshots_++;
  snapshot.t_last_ns = t_stream_ns_.load(std::memory_order_relaxed);
  snapshot.final = flushed_;
  snapshot.readout = readout_;
  snapshots_.publish();
  rt::StageStats::add(stats().n_out);
  due_ = false;
  return rt::StepStatus::kWorked;
}

}  // namespace app
