#pragma once

#include <atomic>

#include "core/types/closure_report.h"
#include "core/types/modal_estimate.h"
#include "firmware_app/chain/structure_comparison.h"
#include "rt/spsc_ring.h"
#include "rt/stage.h"
#include "rt/triple_buffer.h"

namespace app {

// newest estimate -> StructureComparison -> reports. Runs at ordinary priority without a time limit and makes no other
// stage wait: which estimates are compared depends on how long a comparison takes, even with a lossless source.
class StructureStage : public rt::Stage {
 public:
  struct Ends {
    rt::TripleBuffer<core::ModalEstimate>& estimates;
    rt::RingWriter<core::closure::ClosureReport> reports;
  };
  // comparison: not used by anyone else once the stage runs.
  StructureStage(Ends ends, StructureComparison& comparison);

  [[nodiscard]] std::string_view name() const noexcept override { return "structure"; }
  [[nodiscard]] rt::StepStatus step() noexcept override;
  void finish() noexcept override { ends_.reports.close(); }

  // Any thread: a comparison that runs ends without a report, and no other begins.
  void request_stop() noexcept {
    stop_.store(true, std::memory_order_relaxed);  // independent of other data; partner: step()
  }

 private:
  [[nodiscard]] bool is_stopped() const noexcept { return stop_.load(std::memory_order_relaxed); }
  [[nodiscard]] bool report_into(core::closure::ClosureReport& out) noexcept;

  Ends ends_;
  StructureComparison& comparison_;
  std::atomic<bool> stop_{false};
};

}  // namespace app
