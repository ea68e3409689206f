#pragma once

#include <atomic>

#include "core/spectrum/time_grid.h"
#include "core/spectrum/welch_cpsd.h"
#include "core/types/displacement.h"
#include "firmware_app/stages/items.h"
#include "rt/spsc_ring.h"
#include "rt/stage.h"
#include "rt/triple_buffer.h"

namespace app {

// sample ring -> Welch sums -> a snapshot every `period_hops` hops, in stream time. A lossless source hands over every
// due snapshot and waits for it to be taken; a live one may overwrite one that was not, and counts it.
class SpectrumStage : public rt::Stage {
 public:
  SpectrumStage(rt::RingReader<core::DisplacementSample> samples, const core::WelchConfig& config, int period_hops,
                rt::TripleBuffer<SpectrumSnapshot>& snapshots, bool lossless);

  [[nodiscard]] std::string_view name() const noexcept override { return "spectrum"; }
  [[nodiscard]] rt::StepStatus step() noexcept override;
  void finish() noexcept override { snapshots_.close(); }

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
  void take(const core::DisplacementSample& sample) noexcept;
  [[nodiscard]] bool mask_one_missing() noexcept;
  void note_hop(bool hop) noexcept;

  rt::RingReader<core::DisplacementSample> samples_;
  core::TimeGrid grid_;
  core::WelchCpsd welch_;
  std::uint64_t period_hops_;
  rt::TripleBuffer<SpectrumSnapshot>& snapshots_;
  bool lossless_;
  std::uint64_t n_to_mask_ = 0;  // grid cells still to be masked before the sample in front
  bool front_placed_ = false;    // the sample in front has its cell
  bool front_refused_ = false;   // ... and it is already taken
  bool due_ = false;             // a snapshot waits to be handed over
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
