#pragma once

#include <optional>

#include "core/types/closure_report.h"
#include "core/types/track.h"
#include "firmware_app/chain/diagnosis.h"
#include "firmware_app/service/stages/items.h"
#include "rt/spsc_ring.h"
#include "rt/stage.h"

namespace app {

// newest tracks -> Diagnosis -> reports; with closure.adopt: auto also the geometry for tracking from a frame on. Sends
// exactly one change per report, even if nothing changes. Runs at ordinary priority; a report takes seconds. Frames
// wait in the ring meanwhile; those that find no room are gaps in the record. Only a lossless source makes upstream
// stages wait.
class ClosureStage : public rt::Stage {
 public:
  struct Ends {
    rt::RingReader<ShownFrame> tracks;
    rt::RingWriter<core::closure::ClosureReport> reports;
    std::optional<rt::RingWriter<CorrectionSwitch>> changes = {};  // empty: no corrections
  };
  // diagnosis: not used by anyone else once the stage runs.
  ClosureStage(Ends ends, Diagnosis& diagnosis);

  [[nodiscard]] std::string_view name() const noexcept override { return "closure"; }
  [[nodiscard]] rt::StepStatus step() noexcept override;
  void finish() noexcept override;

 private:
  [[nodiscard]] rt::StepStatus report(bool final) noexcept;
  [[nodiscard]] bool report_into(core::closure::ClosureReport& out, bool final) noexcept;

  Ends ends_;
  Diagnosis& diagnosis_;
};

}  // namespace app
