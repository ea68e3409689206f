#pragma once

#include <optional>

#include "core/types/closure_report.h"
#include "core/types/track.h"
#include "firmware_app/chain/diagnosis.h"
#include "firmware_app/service/stages/items.h"
#include "rt/spsc_ring.h"
#include "rt/stage.h"

namespace app {

// newest tracks -> Diagnosis -> reports; with closure.adopt: auto also what tracking shall measure by from a frame on,
// one change per report, be it that nothing changes. Runs at ordinary priority and takes seconds over a report: frames
// wait in the ring meanwhile, and what finds no room is a gap in the record; nothing upstream waits but a lossless
// source.
class ClosureStage : public rt::Stage {
 public:
  struct Ends {
    rt::RingReader<core::TrackFrame> tracks;
    rt::RingWriter<core::closure::ClosureReport> reports;
    std::optional<rt::RingWriter<CorrectionSwitch>> changes = {};  // empty: nothing is taken out
  };
  // diagnosis: touched by nobody else once the stage runs.
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
