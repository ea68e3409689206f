#pragma once

#include "core/identification/mode_tracker.h"
#include "firmware_app/readout_use.h"
#include "firmware_app/stages/items.h"
#include "rt/spsc_ring.h"
#include "rt/stage.h"
#include "rt/triple_buffer.h"

namespace app {

// newest spectrum -> modes, each followed from one estimate to the next. Runs at ordinary priority and may take its
// time: nothing upstream waits for it but a lossless source.
class IdentificationStage : public rt::Stage {
 public:
  IdentificationStage(rt::TripleBuffer<SpectrumSnapshot>& snapshots, const ReadoutUse& identifier,
                      rt::RingWriter<IdentificationResult> results)
      : snapshots_(snapshots),
        identifier_(identifier),
        tracker_({.row_delay_s = identifier.declared_delay_s()}),
        results_(results) {}

  [[nodiscard]] std::string_view name() const noexcept override { return "identification"; }
  [[nodiscard]] rt::StepStatus step() noexcept override;
  void finish() noexcept override { results_.close(); }

 private:
  [[nodiscard]] bool identify(const SpectrumSnapshot& snapshot, IdentificationResult& out) noexcept;

  rt::TripleBuffer<SpectrumSnapshot>& snapshots_;
  const ReadoutUse& identifier_;
  core::ModeTracker tracker_;
  rt::RingWriter<IdentificationResult> results_;
  std::uint64_t n_estimates_ = 0;
};

}  // namespace app
