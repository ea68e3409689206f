#include "firmware_app/service/stages/identification_stage.h"

#include <utility>

namespace app {
namespace {

bool copy(const core::ModalEstimate& from, core::ModalEstimate& to) noexcept {
  try {
    to = from;
    return true;
  } catch (...) {  // out of memory: the next estimate may be compared
    return false;
  }
}

}  // namespace

IdentificationStage::IdentificationStage(Ends ends, ModeIdentification& modes)
    : ends_(std::move(ends)), modes_(modes) {}

rt::StepStatus IdentificationStage::step() noexcept {
  IdentificationResult* slot = ends_.results.try_claim();
  if (slot == nullptr) return rt::StepStatus::kIdle;
  const SpectrumSnapshot* snapshot = ends_.snapshots.front();
  if (snapshot == nullptr) return ends_.snapshots.finished() ? rt::StepStatus::kFinished : rt::StepStatus::kIdle;
  rt::StageStats::add(stats().n_in);
  const bool is_made = identify(*snapshot, *slot);
  ends_.snapshots.pop();
  if (!is_made) {
    rt::StageStats::add(stats().n_dropped);
    return rt::StepStatus::kWorked;
  }
  if (ends_.states != nullptr && modes_.save(ends_.states->back())) ends_.states->publish();
  if (ends_.newest != nullptr && copy(slot->estimate, ends_.newest->back())) ends_.newest->publish();
  ends_.results.publish();
  rt::StageStats::add(stats().n_out);
  return rt::StepStatus::kWorked;
}

void IdentificationStage::finish() noexcept {
  ends_.results.close();
  if (ends_.newest != nullptr) ends_.newest->close();
}

bool IdentificationStage::identify(const SpectrumSnapshot& snapshot, IdentificationResult& out) noexcept {
  try {
    modes_.identify(snapshot, out);
    return true;
  } catch (...) {  // out of memory: this estimate is lost and counted, the next may succeed
    return false;
  }
}

}  // namespace app
