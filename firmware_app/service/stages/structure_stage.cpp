#include "firmware_app/service/stages/structure_stage.h"

#include <exception>
#include <utility>

namespace app {

StructureStage::StructureStage(Ends ends, StructureComparison& comparison)
    : ends_(std::move(ends)), comparison_(comparison) {}

rt::StepStatus StructureStage::step() noexcept {
  core::closure::ClosureReport* slot = ends_.reports.try_claim();
  if (slot == nullptr) return rt::StepStatus::kIdle;
  if (!ends_.estimates.refresh()) return ends_.estimates.finished() ? rt::StepStatus::kFinished : rt::StepStatus::kIdle;
  rt::StageStats::add(stats().n_in);
  if (is_stopped() || !comparison_.is_due(ends_.estimates.front())) return rt::StepStatus::kWorked;
  const bool is_made = report_into(*slot);
  rt::StageStats::add(is_made ? stats().n_out : stats().n_dropped);
  if (is_made) ends_.reports.publish();
  return rt::StepStatus::kWorked;
}

bool StructureStage::report_into(core::closure::ClosureReport& out) noexcept {
  try {
    out = comparison_.report(ends_.estimates.front(), [this] { return !is_stopped(); });
    return true;
  } catch (const std::exception&) {  // stopped, or out of memory: this report is lost and counted
    return false;
  }
}

}  // namespace app
