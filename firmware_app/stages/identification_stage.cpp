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

// Other rate, other folds: what was an apparent frequency is another one now. A new record shares nothing with the old.
void IdentificationStage::follow(const SpectrumSnapshot& snapshot) {
  const bool begins = snapshot.sums.rate_hz != rate_hz_ || snapshot.record != record_;
  if (!begins && snapshot.amendment == amendment_) return;
  identifier_ = make_identifier_(snapshot.sums.rate_hz, book_.at(snapshot.amendment));
  rate_hz_ = snapshot.sums.rate_hz;
  amendment_ = snapshot.amendment, record_ = snapshot.record;
  if (begins) tracker_.restart();
}

bool IdentificationStage::identify(const SpectrumSnapshot& snapshot, IdentificationResult& out) noexcept {
  try {
    follow(snapshot);
    out.estimate = identifier_->identify(snapshot.sums, snapshot.readout);
    out.estimate.amendments = book_.at(amendment_).words;
    tracker_.set_row_delays(identifier_->delay_s(out.estimate));
    out.sums.copy_totals(snapshot.sums, identifier_->n_outputs());
  } catch (...) {  // out of memory: this estimate is lost and counted, the next may succeed
    return false;
  }
  out.estimate.number = n_estimates_++;
  out.estimate.t_stream_ns = snapshot.t_last_ns;
  out.estimate.final = snapshot.final;
  tracker_.update(out.estimate);
  hand_over_state();
  return true;
}

void IdentificationStage::hand_over_state() noexcept {
  if (states_ == nullptr) return;
  StateBytes& state = states_->back();
  core::StateWriter out(state.bytes);
  tracker_.save(out);
  if (!out.ok()) return;
  state.n_used = out.n_used();
  states_->publish();
}

bool IdentificationStage::resume(std::span<const std::uint8_t> bytes) noexcept {
  core::StateReader in(bytes);
  return tracker_.restore(in);
}

}  // namespace app
