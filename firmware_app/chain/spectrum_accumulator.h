#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/rotors/aircraft.h"
#include "core/spectrum/time_grid.h"
#include "core/spectrum/welch_cpsd.h"
#include "core/types/displacement.h"
#include "firmware_app/chain/items.h"

namespace app {

// Samples of all channels -> grid of the frames -> Welch sums, and a snapshot of them every `period_hops` hops, in
// stream time; at the start of a run also after 1, 2, 4 ... segments, until the period is reached. Where overload
// reduces the rate to every n-th frame, or the row delays change, a snapshot of the sums so far is due and new sums
// begin. Where only point positions are corrected, one segment is masked, so that none spans the jump. One thread;
// nothing allocates after construction except the first take_snapshot() into an unsized snapshot.
class SpectrumAccumulator {
 public:
  SpectrumAccumulator(const core::WelchConfig& config, int period_hops);

  // One bounded step: a masked cell before the sample, or the sample itself. False: call again with the same sample.
  // Do not call while a snapshot is due.
  [[nodiscard]] bool step(const core::DisplacementSample& sample) noexcept;
  // A state of the aircraft received before the next sample; snapshots hold all of the run.
  void take(const core::AircraftState& state) noexcept { aircraft_.add(state); }
  // The sample of the last completed step() has no cell of its own (repeated or backward stamp) and was left out.
  [[nodiscard]] bool refused() const noexcept { return is_refused_; }
  // Ends the record: a last snapshot is due.
  void finish() noexcept;
  [[nodiscard]] bool finished() const noexcept { return is_finished_; }

  [[nodiscard]] bool is_due() const noexcept { return is_due_; }
  void take_snapshot(SpectrumSnapshot& out) noexcept;
  // The same without a copy of the sums: they are sums(), until the next step.
  [[nodiscard]] SnapshotHead take_head() noexcept;

  // Set-up only. state_is_due() becomes true every half `period_s` of stream time, between two samples; not while
  // overload thins the frames, and not once a correction is in force.
  void keep_state(double period_s) noexcept;
  [[nodiscard]] bool state_is_due() const noexcept;
  [[nodiscard]] std::size_t state_bytes() const noexcept { return welch_.state_bytes() + 256; }  // upper bound
  // False: it does not fit. In either case the next state is due a period later.
  [[nodiscard]] bool save(StateBytes& out) noexcept;
  // Before the first sample: continues the sums of an earlier run. clock_goes_on: the new stamps are on the same clock
  // as the old ones, so that the gap between is known; otherwise one segment is masked. False: the bytes do not fit,
  // and the sums are empty.
  [[nodiscard]] bool resume(std::span<const std::uint8_t> bytes, bool clock_goes_on) noexcept;
  // Takes over the sums of an accumulator of the same configuration, which loses them.
  void go_on_from(SpectrumAccumulator& earlier) noexcept;
  // Before the first sample, or where displacements do not jump: the next one comes under this correction set.
  void begin_as(std::uint32_t correction_set, std::uint32_t record) noexcept {
    correction_set_ = correction_set, record_ = record;
  }
  // Between two samples: goes on as `rebuilt`, of the same configuration, which has had all samples before the next
  // one. modes: what identification is to go on with, named in every snapshot from now on.
  void take_over(SpectrumAccumulator& rebuilt, ModeIdentification& modes) noexcept;

  [[nodiscard]] const core::CpsdSums& sums() const noexcept { return welch_.sums(); }
  [[nodiscard]] std::uint64_t n_masked() const noexcept { return n_masked_before_ + welch_.sums().n_missing; }
  [[nodiscard]] std::uint64_t n_missing() const noexcept { return n_missing_; }  // cells of the grid without a sample
  [[nodiscard]] std::int64_t t_stream_ns() const noexcept { return t_stream_ns_; }  // of the newest sample
  [[nodiscard]] double worst_jitter_cells() const noexcept { return grid_.worst_jitter_cells(); }
  [[nodiscard]] const core::ReadoutEstimate& readout() const noexcept { return readout_; }  // as of the newest sample

 private:
  [[nodiscard]] bool begin_other_sums(const core::DisplacementSample& sample) noexcept;
  void place(const core::DisplacementSample& sample) noexcept;
  void note_hop(bool hop) noexcept;
  [[nodiscard]] std::uint64_t segment() const noexcept { return static_cast<std::uint64_t>(welch_.sums().n_fft / 2); }

  double camera_rate_hz_;
  core::TimeGrid grid_;
  core::WelchCpsd welch_;
  std::uint64_t period_hops_;
  std::uint32_t stride_ = 1;                       // of the samples in the sums
  std::uint32_t record_ = 0, correction_set_ = 0;  // likewise; correction_set is that of the newest
  std::uint64_t n_masked_before_ = 0;              // in earlier sums of this run
  std::uint64_t n_missing_ = 0;
  std::uint64_t state_period_cells_ = 0, next_state_cell_ = 0;  // period 0: no state is kept
  std::uint64_t n_masked_on_resume_ = 0;                        // cells to be masked before the first sample
  std::uint64_t n_to_mask_ = 0;                                 // cells still to be masked before the current sample
  bool is_placed_ = false;                                      // the current sample has its cell
  bool is_refused_ = false;                                     // ... and that cell is already taken
  bool old_sums_ended_ = false;  // the last snapshot before the change of rate or row delays has been made due
  bool is_due_ = false, is_finished_ = false;
  bool has_begun_again_ = false;  // the sums are not the first of this run
  std::int64_t t_stream_ns_ = 0;
  core::ReadoutEstimate readout_;
  core::AircraftLog aircraft_;
  std::uint64_t n_snapshots_ = 0;
  ModeIdentification* rebuilt_modes_ = nullptr;
};

}  // namespace app
