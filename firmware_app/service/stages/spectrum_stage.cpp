#include "firmware_app/service/stages/spectrum_stage.h"

#include <utility>

#include "firmware_app/chain/rebuild.h"

namespace app {

SpectrumStage::SpectrumStage(Ends ends, SpectrumAccumulator& spectra, bool lossless)
    : ends_(std::move(ends)), spectra_(spectra), lossless_(lossless) {}

rt::StepStatus SpectrumStage::step() noexcept {
  if (spectra_.is_due()) return hand_over();
  if (ends_.states != nullptr && spectra_.state_is_due()) hand_over_state();
  const core::DisplacementSample* sample = ends_.samples.front();
  if (sample == nullptr) return ends_.samples.finished() ? end_record() : rt::StepStatus::kIdle;
  take_over(sample->sequence);
  take_aircraft(sample->sequence);
  const bool is_done = spectra_.step(*sample);
  note();
  if (!is_done) return rt::StepStatus::kWorked;
  ends_.samples.pop();
  rt::StageStats::add(stats().n_in);
  if (spectra_.refused()) rt::StageStats::add(stats().n_dropped);
  return rt::StepStatus::kWorked;
}

rt::StepStatus SpectrumStage::end_record() noexcept {
  if (spectra_.finished()) return rt::StepStatus::kFinished;
  spectra_.finish();
  return rt::StepStatus::kWorked;
}

rt::StepStatus SpectrumStage::hand_over() noexcept {
  SpectrumSnapshot* slot = ends_.snapshots.try_claim();
  if (slot == nullptr) {
    const bool waits = waits_.load(std::memory_order_relaxed);
    if (waits && (lossless_ || spectra_.finished())) return rt::StepStatus::kIdle;  // the last one is never skipped
    n_skipped_.store(n_skipped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    (void)spectra_.take_head();
    return rt::StepStatus::kWorked;
  }
  spectra_.take_snapshot(*slot);
  ends_.snapshots.publish();
  rt::StageStats::add(stats().n_out);
  return rt::StepStatus::kWorked;
}

void SpectrumStage::hand_over_state() noexcept {
  if (spectra_.save(ends_.states->back())) ends_.states->publish();
}

// Those received before the frame of that number, whenever this thread runs: a replay does the same.
void SpectrumStage::take_aircraft(std::uint64_t sequence) noexcept {
  if (!ends_.aircraft) return;
  for (const AircraftUpdate* update = ends_.aircraft->front(); update != nullptr && update->before_sequence <= sequence;
       update = ends_.aircraft->front()) {
    spectra_.take(update->state);
    ends_.aircraft->pop();
  }
}

void SpectrumStage::take_over(std::uint64_t sequence) noexcept {
  if (!ends_.takeovers) return;
  for (const Takeover* next = ends_.takeovers->front(); next != nullptr && next->from_sequence <= sequence;
       next = ends_.takeovers->front()) {
    spectra_.take_over(next->rebuilt->spectra(), next->rebuilt->modes());
    next->rebuilt->note_spectra_taken();
    ends_.takeovers->pop();
  }
}

void SpectrumStage::note() noexcept {
  n_masked_.store(spectra_.n_masked(), std::memory_order_relaxed);
  t_stream_ns_.store(spectra_.t_stream_ns(), std::memory_order_relaxed);
  worst_jitter_cells_.store(spectra_.worst_jitter_cells(), std::memory_order_relaxed);
}

void SpectrumStage::finish() noexcept {
  ends_.snapshots.close();
  if (ends_.states != nullptr) ends_.states->close();
}

}  // namespace app
