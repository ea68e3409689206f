#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/types/closure_report.h"
#include "core/types/track.h"
#include "firmware_app/loop_closer.h"
#include "firmware_app/stages/items.h"
#include "rt/spsc_ring.h"
#include "rt/stage.h"

namespace app {

// newest tracks -> LoopCloser -> reports; with closure.adopt: auto also what tracking shall measure by from a frame on.
// Runs at ordinary priority and takes seconds over a report: frames wait in the ring meanwhile, and what finds no room
// is a gap in the record; nothing upstream waits but a lossless source.
class ClosureStage : public rt::Stage {
 public:
  using MakeGeometry = std::function<std::unique_ptr<Geometry>(const Amendment&)>;

  ClosureStage(rt::RingReader<core::TrackFrame> tracks, LoopCloserConfig config,
               rt::RingWriter<core::closure::ClosureReport> reports);

  // Set-up only: adopt. One change goes out per report, be it that nothing changes. make may throw: nothing changes.
  void amend(AmendmentBook& book, MakeGeometry make, rt::RingWriter<ViewChange> changes);
  // Set-up only: before anything has come.
  [[nodiscard]] ViewChange first_view() const noexcept;

  [[nodiscard]] std::string_view name() const noexcept override { return "closure"; }
  [[nodiscard]] rt::StepStatus step() noexcept override;
  void finish() noexcept override;

 private:
  [[nodiscard]] rt::StepStatus report(bool final) noexcept;
  void amend(core::closure::ClosureReport& report);
  void tell_tracking() noexcept;

  rt::RingReader<core::TrackFrame> tracks_;
  LoopCloser loop_;
  rt::RingWriter<core::closure::ClosureReport> reports_;
  AmendmentBook* book_ = nullptr;
  MakeGeometry make_;
  std::optional<rt::RingWriter<ViewChange>> changes_;
  ViewChange change_;                            // of the last report
  std::vector<std::unique_ptr<Geometry>> made_;  // tracking measures by the last but one or the last
};

}  // namespace app
