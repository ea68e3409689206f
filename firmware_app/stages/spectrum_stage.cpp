#include "firmware_app/stages/spectrum_stage.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace app {

SpectrumStage::SpectrumStage(rt::RingReader<core::DisplacementSample> samples, const core::WelchConfig& config,
                             int period_hops, rt::TripleBuffer<SpectrumSnapshot>& snapshots, bool lossless,
                             const ThinningSchedule& thinning)
    : samples_(std::move(samples)),
      camera_rate_hz_(config.rate_hz),
      grid_(config.rate_hz),
      welch_(config),
      period_hops_(static_cast<std::uint64_t>(std::max(1, period_hops))),
      snapshots_(snapshots),
      lossless_(lossless),
      thinning_(thinning) {}

rt::StepStatus SpectrumStage::step() noexcept {
  if (due_) return hand_over();
  hand_over_state_when_due();
  if (n_to_mask_ > 0) {
    note_hop(mask_one_missing());
    return rt::StepStatus::kWorked;
  }
  const core::DisplacementSample* sample = samples_.front();
  if (sample == nullptr) return samples_.finished() ? end_record() : rt::StepStatus::kIdle;
  if (!front_placed_) {
    const std::uint32_t stride = thinning_.at(sample->sequence).stride;
    const bool is_other = stride != stride_ || sample->record != record_;
    if (is_other && !begin_other_sums(stride, sample->record)) return rt::StepStatus::kWorked;
    const bool jumps = !is_other && sample->amendment != amendment_;
    amendment_ = sample->amendment;
    const core::TimeGrid::Placement placement = grid_.place(sample->t_start_ns);
    front_placed_ = true;
    front_refused_ = !placement.accepted;
    worst_jitter_cells_.store(grid_.worst_jitter_cells(), std::memory_order_relaxed);
    // After a gap of more than two segments nothing of the old samples is left in the segment being gathered: more
    // masked cells would only add empty segments.
    n_to_mask_ =
        std::min<std::uint64_t>(placement.n_missing_before, 2 * static_cast<std::uint64_t>(welch_.sums().n_fft));
    if (placement.accepted) n_to_mask_ += std::exchange(n_masked_on_resume_, 0);
    if (jumps) n_to_mask_ += static_cast<std::uint64_t>(welch_.sums().n_fft / 2);
    if (n_to_mask_ > 0) return rt::StepStatus::kWorked;
  }
  take(*sample);
  samples_.pop();
  front_placed_ = false;
  rt::StageStats::add(stats().n_in);
  return rt::StepStatus::kWorked;
}

// False: the old sums are to be handed over first.
bool SpectrumStage::begin_other_sums(std::uint32_t stride, std::uint32_t record) noexcept {
  if (welch_.sums().n_segments > 0 && !old_sums_ended_) {
    old_sums_ended_ = due_ = true;
    return false;
  }
  n_masked_before_ += welch_.sums().n_missing;
  welch_.restart(camera_rate_hz_ / stride);
  if (stride != stride_) grid_ = core::TimeGrid(camera_rate_hz_ / stride);
  stride_ = stride, record_ = record;
  old_sums_ended_ = false;
  return true;
}

void SpectrumStage::take(const core::DisplacementSample& sample) noexcept {
  if (front_refused_) {
    rt::StageStats::add(stats().n_dropped);
    return;
  }
  t_stream_ns_.store(sample.t_start_ns, std::memory_order_relaxed);
  readout_ = sample.readout;
  note_hop(welch_.push(sample));
}

bool SpectrumStage::mask_one_missing() noexcept {
  --n_to_mask_;
  return welch_.push_missing();
}

void SpectrumStage::note_hop(bool hop) noexcept {
  n_masked_.store(n_masked_before_ + welch_.sums().n_missing, std::memory_order_relaxed);
  due_ = hop && welch_.n_hops() % period_hops_ == 0;
}

rt::StepStatus SpectrumStage::end_record() noexcept {
  if (flushed_) return rt::StepStatus::kFinished;
  welch_.flush();
  flushed_ = true;
  due_ = true;
  return rt::StepStatus::kWorked;
}

void SpectrumStage::keep_state(rt::TripleBuffer<StateBytes>& states, double period_s) noexcept {
  states_ = &states;
  constexpr double kShareUntilWritten = 0.5;  // the rest is the disk's
  state_period_cells_ =
      static_cast<std::uint64_t>(std::max(1.0, std::floor(kShareUntilWritten * period_s * camera_rate_hz_)));
  next_state_cell_ = welch_.sums().n_samples + state_period_cells_;
}

void SpectrumStage::hand_over_state_when_due() noexcept {
  // A sample that has its cell but is not in the sums yet would be lost to the next run.
  const bool between_samples = n_to_mask_ == 0 && !front_placed_;
  const bool is_plain = stride_ == 1 && amendment_ == 0;
  if (states_ == nullptr || !is_plain || !between_samples || welch_.sums().n_samples < next_state_cell_) return;
  next_state_cell_ = welch_.sums().n_samples + state_period_cells_;
  StateBytes& state = states_->back();
  core::StateWriter out(state.bytes);
  grid_.save(out);
  welch_.save(out);
  if (!out.ok()) return;
  state.n_used = out.n_used();
  states_->publish();
}

bool SpectrumStage::resume(std::span<const std::uint8_t> bytes, bool clock_goes_on) noexcept {
  core::StateReader in(bytes);
  core::TimeGrid grid(camera_rate_hz_);
  grid.restore(in);
  if (!welch_.restore(in)) return false;
  if (clock_goes_on) {
    grid_ = grid;
  } else {
    n_masked_on_resume_ = static_cast<std::uint64_t>(welch_.sums().n_fft / 2);  // at least a segment
  }
  note_hop(false);
  if (states_ != nullptr) next_state_cell_ = welch_.sums().n_samples + state_period_cells_;
  return true;
}

void SpectrumStage::finish() noexcept {
  snapshots_.close();
  if (states_ != nullptr) states_->close();
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
  snapshot.amendment = amendment_, snapshot.record = record_;
  snapshot.readout = readout_;
  snapshot.readout.frames /= stride_;  // frames are longer now
  snapshot.readout.std_frames /= stride_;
  snapshots_.publish();
  rt::StageStats::add(stats().n_out);
  due_ = false;
  return rt::StepStatus::kWorked;
}

}  // namespace app
