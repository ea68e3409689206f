#include "firmware_app/stages/identification_stage.h"

namespace app {

rt::StepStatus IdentificationStage::step() noexcept {
  IdentificationResult* slot = results_.try_claim();
  if (slot == nullptr) return rt::StepStatus::kIdle;
  if (!snapshots_.refresh()) return snapshots_.finished() ? rt::StepStatus::kFinished : rt::StepStatus::kIdle;
  rt::StageStats::add(stats().n_in);
  if (!identify(snapshots_.front(), *slot)) {
    rt::StageStats::add(stats().n_dropped);
    return rt::StepStatus::kWorked;
  }
  results_.publish();
  rt::StageStats::add(stats().n_out);
  return rt::StepStatus::kWorked;
}

bool IdentificationStage::identify(const SpectrumSnapshot& snapshot, IdentificationResult& out) noexcept {
  try {
    out.estimate = identifier_.identify(snapshot.sums, snapshot.readout);
    tracker_.set_row_delays(identifier_.delay_s(out.estimate));
    out.sums.copy_totals(snapshot.sums);
  } catch (...) {  // out of memory: this estimate is lost and counted, the next may succeed
    return false;
  }
  out.estimate.number = n_estimates_++;
  out.estimate.t_stream_ns = snapshot.t_last_ns;
  out.estimate.final = snapshot.final;
  tracker_.update(out.estimate);
  return true;
}

}  // namespace app
