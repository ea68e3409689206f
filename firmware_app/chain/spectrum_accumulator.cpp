#include "firmware_app/chain/spectrum_accumulator.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <utility>

namespace app {

SpectrumAccumulator::SpectrumAccumulator(const core::WelchConfig& config, int period_hops)
    : camera_rate_hz_(config.rate_hz),
      grid_(config.rate_hz),
      welch_(config),
      period_hops_(static_cast<std::uint64_t>(std::max(1, period_hops))) {}

bool SpectrumAccumulator::step(const core::DisplacementSample& sample) noexcept {
  assert(!is_due_);
  if (n_to_mask_ > 0) {
    --n_to_mask_;
    note_hop(welch_.push_missing());
    return false;
  }
  if (!is_placed_) {
    const bool is_other = sample.stride != stride_ || sample.record != record_;
    if (is_other && !begin_other_sums(sample)) return false;
    const bool jumps = !is_other && sample.correction_set != correction_set_;
    correction_set_ = sample.correction_set;
    place(sample);
    if (jumps) n_to_mask_ += segment();
    if (n_to_mask_ > 0) return false;
  }
  is_placed_ = false;
  if (is_refused_) return true;
  t_stream_ns_ = sample.t_start_ns;
  readout_ = sample.readout;
  note_hop(welch_.push(sample));
  return true;
}

// Sums that begin again in mid-run follow estimates from more data than their first segments hold.
void SpectrumAccumulator::note_hop(bool hop) noexcept {
  const std::uint64_t n = welch_.n_hops();
  const bool is_early = !has_begun_again_ && n < period_hops_ && std::has_single_bit(n);
  is_due_ = hop && (is_early || n % period_hops_ == 0);
}

void SpectrumAccumulator::place(const core::DisplacementSample& sample) noexcept {
  const core::TimeGrid::Placement placement = grid_.place(sample.t_start_ns);
  is_placed_ = true;
  is_refused_ = !placement.accepted;
  n_missing_ += placement.n_missing_before;
  // After a gap of more than two segments, the segment being gathered contains no old samples: further masked cells
  // would only add empty segments. The stamps of a record may lie years apart.
  n_to_mask_ = std::min<std::uint64_t>(placement.n_missing_before, 4 * segment());
  if (placement.accepted) n_to_mask_ += std::exchange(n_masked_on_resume_, 0);
}

// False: a snapshot of the old sums is due first.
bool SpectrumAccumulator::begin_other_sums(const core::DisplacementSample& sample) noexcept {
  if (welch_.sums().n_segments > 0 && !old_sums_ended_) {
    old_sums_ended_ = is_due_ = true;
    return false;
  }
  has_begun_again_ = has_begun_again_ || welch_.sums().n_segments > 0;
  n_masked_before_ += welch_.sums().n_missing;
  welch_.restart(camera_rate_hz_ / sample.stride);
  if (sample.stride != stride_) grid_ = core::TimeGrid(camera_rate_hz_ / sample.stride);
  stride_ = sample.stride, record_ = sample.record;
  old_sums_ended_ = false;
  return true;
}

void SpectrumAccumulator::finish() noexcept {
  welch_.flush();
  is_finished_ = is_due_ = true;
}

void SpectrumAccumulator::take_snapshot(SpectrumSnapshot& out) noexcept {
  out.sums = welch_.sums();  // same sizes: copies values, allocates nothing
  static_cast<SnapshotHead&>(out) = take_head();
}

SnapshotHead SpectrumAccumulator::take_head() noexcept {
  SnapshotHead out;
  out.number = n_snapshots_++;
  out.t_last_ns = t_stream_ns_;
  out.final = is_finished_;
  out.correction_set = correction_set_, out.record = record_;
  out.readout = readout_;
  out.readout.frames /= stride_;  // the kept frames are longer
  out.readout.std_frames /= stride_;
  out.aircraft = aircraft_;
  out.rebuilt = rebuilt_modes_;
  is_due_ = false;
  return out;
}

void SpectrumAccumulator::keep_state(double period_s) noexcept {
  constexpr double kShareUntilWritten = 0.5;  // the remaining time is left for writing to disk
  state_period_cells_ =
      static_cast<std::uint64_t>(std::max(1.0, std::floor(kShareUntilWritten * period_s * camera_rate_hz_)));
  next_state_cell_ = welch_.sums().n_samples + state_period_cells_;
}

bool SpectrumAccumulator::state_is_due() const noexcept {
  // A sample that has its cell but is not yet in the sums would be lost to the next run.
  const bool is_between_samples = n_to_mask_ == 0 && !is_placed_;
  const bool is_plain = stride_ == 1 && correction_set_ == 0;
  return state_period_cells_ > 0 && is_plain && is_between_samples && welch_.sums().n_samples >= next_state_cell_;
}

bool SpectrumAccumulator::save(StateBytes& state) noexcept {
  next_state_cell_ = welch_.sums().n_samples + state_period_cells_;
  core::StateWriter out(state.bytes);
  grid_.save(out);
  welch_.save(out);
  state.n_used = out.n_used();
  return out.ok();
}

bool SpectrumAccumulator::resume(std::span<const std::uint8_t> bytes, bool clock_goes_on) noexcept {
  core::StateReader in(bytes);
  core::TimeGrid grid(camera_rate_hz_);
  grid.restore(in);
  if (!welch_.restore(in)) return false;
  if (clock_goes_on) {
    grid_ = grid;
  } else {
    n_masked_on_resume_ = segment();
  }
  next_state_cell_ = welch_.sums().n_samples + state_period_cells_;
  return true;
}

void SpectrumAccumulator::go_on_from(SpectrumAccumulator& earlier) noexcept {
  std::swap(welch_, earlier.welch_);
  stride_ = earlier.stride_;
  n_masked_before_ = earlier.n_masked_before_;
  n_missing_ = earlier.n_missing_;
  n_masked_on_resume_ = segment();
  aircraft_ = earlier.aircraft_;
}

void SpectrumAccumulator::take_over(SpectrumAccumulator& rebuilt, ModeIdentification& modes) noexcept {
  rebuilt.aircraft_ = aircraft_;
  std::swap(*this, rebuilt);
  rebuilt_modes_ = &modes;
}

}  // namespace app
