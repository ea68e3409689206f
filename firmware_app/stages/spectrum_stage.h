#pragma once

#include <atomic>
#include <cstdint>
#include <span>

#include "core/spectrum/time_grid.h"
#include "core/spectrum/welch_cpsd.h"
#include "core/types/displacement.h"
#include "firmware_app/stages/items.h"
#include "firmware_app/stages/thinning.h"
#include "rt/spsc_ring.h"
#include "rt/stage.h"
#include "rt/triple_buffer.h"

namespace app {

// sample ring -> Welch sums -> a snapshot every `period_hops` hops, in stream time. A lossless source hands over every
// due snapshot and waits for it to be taken; a live one may overwrite one that was not, and counts it. Where capture
// begins to keep every n-th frame only, or the rows' delays change, the sums so far are handed over and new ones begin.
// Where only the points' places are amended, one segment is masked: none spans the jump.
class SpectrumStage : public rt::Stage {
 public:
  SpectrumStage(rt::RingReader<core::DisplacementSample> samples, const core::WelchConfig& config, int period_hops,
                rt::TripleBuffer<SpectrumSnapshot>& snapshots, bool lossless, const ThinningSchedule& thinning);

  // Set-up only. Every half `period_s` of stream time the state is handed over, for a later run's resume(); not while
  // overload thins the frames.
  void keep_state(rt::TripleBuffer<StateBytes>& states, double period_s) noexcept;
  [[nodiscard]] std::size_t state_bytes() const noexcept { return welch_.state_bytes() + 256; }
  // Set-up only: goes on with the sums of an earlier run. clock_goes_on: the stamps that will come are of the same
  // clock as those before, so that the gap between is known; else one segment is masked. False: the bytes do not fit,
  // and the sums are empty.
  [[nodiscard]] bool resume(std::span<const std::uint8_t> bytes, bool clock_goes_on) noexcept;
  [[nodiscard]] const core::CpsdSums& sums() const noexcept { return welch_.sums(); }  // set-up only

  [[nodiscard]] std::string_view name() const noexcept override { return "spectrum"; }
  [[nodiscard]] rt::StepStatus step() noexcept override;
  void finish() noexcept override;

  // Any thread.
  [[nodiscard]] std::uint64_t n_masked() const noexcept { return n_masked_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t n_skipped() const noexcept { return n_skipped_.load(std::memory_order_relaxed); }
  [[nodiscard]] double worst_jitter_cells() const noexcept {
    return worst_jitter_cells_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] std::int64_t t_stream_ns() const noexcept { return t_stream_ns_.load(std::memory_order_relaxed); }

 private:
  [[nodiscard]] rt::StepStatus hand_over() noexcept;
  [[nodiscard]] rt::StepStatus end_record() noexcept;
  [[nodiscard]] bool begin_other_sums(std::uint32_t stride, std::uint32_t record) noexcept;
  void take(const core::DisplacementSample& sample) noexcept;
  [[nodiscard]] bool mask_one_missing() noexcept;
  void note_hop(bool hop) noexcept;
  void hand_over_state_when_due() noexcept;

  rt::RingReader<core::DisplacementSample> samples_;
  double camera_rate_hz_;
  core::TimeGrid grid_;
  core::WelchCpsd welch_;
  std::uint64_t period_hops_;
  rt::TripleBuffer<SpectrumSnapshot>& snapshots_;
  bool lossless_;
  const ThinningSchedule& thinning_;
  std::uint32_t stride_ = 1;                        // of the samples in the sums
  std::uint32_t record_ = 0, amendment_ = 0;        // likewise; the amendment of the newest
  std::uint64_t n_masked_before_ = 0;               // in sums that were ended
  rt::TripleBuffer<StateBytes>* states_ = nullptr;  // null: no state is kept
  std::uint64_t state_period_cells_ = 0, next_state_cell_ = 0;
  std::uint64_t n_masked_on_resume_ = 0;  // cells to be masked before the first sample
  std::uint64_t n_to_mask_ = 0;           // grid cells still to be masked before the sample in front
  bool front_placed_ = false;             // the sample in front has its cell
  bool front_refused_ = false;            // ... and it is already taken
  bool old_sums_ended_ = false;           // the last sums of the old rate, or amendment, were made due
  bool due_ = false;                      // a snapshot waits to be handed over
  bool flushed_ = false;
  core::ReadoutEstimate readout_;
  std::uint64_t n_snapshots_ = 0;
  // Written here only; relaxed: each is a number on its own.
  std::atomic<std::uint64_t> n_masked_{0};
  std::atomic<std::uint64_t> n_skipped_{0};
  std::atomic<std::int64_t> t_stream_ns_{0};
  std::atomic<double> worst_jitter_cells_{0.0};
};

}  // namespace app
