#include "firmware_app/service/stages/closure_stage.h"

#include <exception>
#include <utility>

namespace app {

ClosureStage::ClosureStage(Ends ends, Diagnosis& diagnosis) : ends_(std::move(ends)), diagnosis_(diagnosis) {}

rt::StepStatus ClosureStage::step() noexcept {
  if (diagnosis_.is_due()) return report(false);
  if (const ShownFrame* frame = ends_.tracks.front()) {
    diagnosis_.take(frame->tracks, frame->stride);
    ends_.tracks.pop();
    rt::StageStats::add(stats().n_in);
    return rt::StepStatus::kWorked;
  }
  diagnosis_.offer();
  if (!ends_.tracks.finished()) return rt::StepStatus::kIdle;
  return diagnosis_.is_left() ? report(true) : rt::StepStatus::kFinished;
}

rt::StepStatus ClosureStage::report(bool final) noexcept {
  core::closure::ClosureReport* slot = ends_.reports.try_claim();
  CorrectionSwitch* change = ends_.changes ? ends_.changes->try_claim() : nullptr;
  if (slot == nullptr || (ends_.changes && change == nullptr)) return rt::StepStatus::kIdle;
  const bool is_made = report_into(*slot, final);
  if (change != nullptr) {
    *change = diagnosis_.change();
    ends_.changes->publish();
  }
  rt::StageStats::add(is_made ? stats().n_out : stats().n_dropped);
  if (is_made) ends_.reports.publish();
  return rt::StepStatus::kWorked;
}

bool ClosureStage::report_into(core::closure::ClosureReport& out, bool final) noexcept {
  try {
    out = diagnosis_.report(final);
    return true;
  } catch (const std::exception&) {  // out of memory: this report is lost and counted, the next may succeed
    return false;
  }
}

void ClosureStage::finish() noexcept {
  ends_.reports.close();
  if (ends_.changes) ends_.changes->close();
}

}  // namespace app
