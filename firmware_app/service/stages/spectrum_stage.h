#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "core/types/displacement.h"
#include "firmware_app/chain/spectrum_accumulator.h"
#include "firmware_app/service/stages/items.h"
#include "rt/spsc_ring.h"
#include "rt/stage.h"
#include "rt/triple_buffer.h"

namespace app {

// sample ring -> SpectrumAccumulator -> snapshots, and the state for a later run. A lossless source hands over every
// due snapshot and waits for a free slot; a live one skips the snapshot, which is counted.
class SpectrumStage : public rt::Stage {
 public:
  struct Ends {
    rt::RingReader<core::DisplacementSample> samples;
    rt::RingWriter<SpectrumSnapshot> snapshots;
    rt::TripleBuffer<StateBytes>* states = nullptr;  // null: no state is kept
    std::optional<rt::RingReader<AircraftUpdate>> aircraft = {};
    std::optional<rt::RingReader<Takeover>> takeovers = {};
  };
  // spectra: not used by anyone else once the stage runs.
  SpectrumStage(Ends ends, SpectrumAccumulator& spectra, bool lossless);

  [[nodiscard]] std::string_view name() const noexcept override { return "spectrum"; }
  [[nodiscard]] rt::StepStatus step() noexcept override;
  void finish() noexcept override;

  // Any thread: from now on no snapshot waits until it is read, not even the last one.
  void stop_waiting() noexcept {
    waits_.store(false, std::memory_order_relaxed);  // independent of other data; partner: hand_over()
    wakeup().nudge();
  }
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
  void hand_over_state() noexcept;
  void take_aircraft(std::uint64_t sequence) noexcept;
  void take_over(std::uint64_t sequence) noexcept;
  void note() noexcept;

  Ends ends_;
  SpectrumAccumulator& spectra_;
  bool lossless_;
  std::atomic<bool> waits_{true};
  // Written here only; relaxed: each counter is independent of other data.
  std::atomic<std::uint64_t> n_masked_{0};
  std::atomic<std::uint64_t> n_skipped_{0};
  std::atomic<std::int64_t> t_stream_ns_{0};
  std::atomic<double> worst_jitter_cells_{0.0};
};

}  // namespace app
