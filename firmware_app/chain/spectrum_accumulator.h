#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/spectrum/time_grid.h"
#include "core/spectrum/welch_cpsd.h"
#include "core/types/displacement.h"
#include "firmware_app/chain/items.h"

namespace app {

// Samples of all channels -> the grid of the frames -> Welch sums, and a snapshot of them every `period_hops` hops, in
// stream time. Where overload begins to keep every n-th frame only, or the rows' delays change, a snapshot of the sums
// so far is due and new ones begin. Where only the points' places are corrected, one segment is masked: none spans the
// jump. One thread; nothing allocates after construction but in the first take_snapshot() into an unsized snapshot.
class SpectrumAccumulator {
 public:
  SpectrumAccumulator(const core::WelchConfig& config, int period_hops);

  // One bounded step: a masked cell before the sample, or the sample itself. False: call again with the same sample.
  // Not while a snapshot is due.
  [[nodiscard]] bool step(const core::DisplacementSample& sample) noexcept;
  // The last sample that step() was done with lies in no cell of its own (repeated or backward stamp): it is left out.
  [[nodiscard]] bool refused() const noexcept { return is_refused_; }
  // The end of the record: a last snapshot is due.
  void finish() noexcept;
  [[nodiscard]] bool finished() const noexcept { return is_finished_; }

  [[nodiscard]] bool is_due() const noexcept { return is_due_; }
  void take_snapshot(SpectrumSnapshot& out) noexcept;

  // Set-up only: state_is_due() every half `period_s` of stream time, between two samples; not while overload thins the
  // frames, and not once anything is corrected.
  void keep_state(double period_s) noexcept;
  [[nodiscard]] bool state_is_due() const noexcept;
  [[nodiscard]] std::size_t state_bytes() const noexcept { return welch_.state_bytes() + 256; }  // at most
  // False: it does not fit. Due again a period later either way.
  [[nodiscard]] bool save(StateBytes& out) noexcept;
  // Before the first sample: goes on with the sums of an earlier run. clock_goes_on: the stamps that will come are of
  // the same clock as those before, so that the gap between is known; else one segment is masked. False: the bytes do
  // not fit, and the sums are empty.
  [[nodiscard]] bool resume(std::span<const std::uint8_t> bytes, bool clock_goes_on) noexcept;
  // The same with the sums of an accumulator of this configuration, which loses them.
  void go_on_from(SpectrumAccumulator& earlier) noexcept;

  [[nodiscard]] const core::CpsdSums& sums() const noexcept { return welch_.sums(); }
  [[nodiscard]] std::uint64_t n_masked() const noexcept { return n_masked_before_ + welch_.sums().n_missing; }
  [[nodiscard]] std::uint64_t n_missing() const noexcept { return n_missing_; }  // cells of the grid without a sample
  [[nodiscard]] std::int64_t t_stream_ns() const noexcept { return t_stream_ns_; }  // of the newest sample
  [[nodiscard]] double worst_jitter_cells() const noexcept { return grid_.worst_jitter_cells(); }
  [[nodiscard]] const core::ReadoutEstimate& readout() const noexcept { return readout_; }  // with the newest sample

 private:
  [[nodiscard]] bool begin_other_sums(const core::DisplacementSample& sample) noexcept;
  void place(const core::DisplacementSample& sample) noexcept;
  void note_hop(bool hop) noexcept { is_due_ = hop && welch_.n_hops() % period_hops_ == 0; }
  [[nodiscard]] std::uint64_t segment() const noexcept { return static_cast<std::uint64_t>(welch_.sums().n_fft / 2); }

  double camera_rate_hz_;
  core::TimeGrid grid_;
  core::WelchCpsd welch_;
  std::uint64_t period_hops_;
  std::uint32_t stride_ = 1;                  // of the samples in the sums
  std::uint32_t record_ = 0, correction_set_ = 0;  // likewise; the correction_set of the newest
  std::uint64_t n_masked_before_ = 0;         // in sums that were ended
  std::uint64_t n_missing_ = 0;
  std::uint64_t state_period_cells_ = 0, next_state_cell_ = 0;  // period 0: no state is kept
  std::uint64_t n_masked_on_resume_ = 0;                        // cells to be masked before the first sample
  std::uint64_t n_to_mask_ = 0;                                 // cells still to be masked before the sample in front
  bool is_placed_ = false;                                      // the sample in front has its cell
  bool is_refused_ = false;                                     // ... and it is already taken
  bool old_sums_ended_ = false;  // the last snapshot of the old rate, or rows' delays, was made due
  bool is_due_ = false, is_finished_ = false;
  std::int64_t t_stream_ns_ = 0;
  core::ReadoutEstimate readout_;
  std::uint64_t n_snapshots_ = 0;
};

}  // namespace app
