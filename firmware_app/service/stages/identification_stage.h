#pragma once

#include "firmware_app/chain/mode_identification.h"
#include "firmware_app/service/stages/items.h"
#include "rt/spsc_ring.h"
#include "rt/stage.h"
#include "rt/triple_buffer.h"

namespace app {

// oldest snapshot -> ModeIdentification -> results, and the modes followed for a later run. Runs at ordinary priority
// without a time limit: only a lossless source makes upstream stages wait for it.
class IdentificationStage : public rt::Stage {
 public:
  struct Ends {
    rt::RingReader<SpectrumSnapshot> snapshots;
    rt::RingWriter<IdentificationResult> results;
    rt::TripleBuffer<StateBytes>* states = nullptr;           // null: no state is kept
    rt::TripleBuffer<core::ModalEstimate>* newest = nullptr;  // null: no structure is declared
  };
  // modes: not used by anyone else once the stage runs.
  IdentificationStage(Ends ends, ModeIdentification& modes);

  [[nodiscard]] std::string_view name() const noexcept override { return "identification"; }
  [[nodiscard]] rt::StepStatus step() noexcept override;
  void finish() noexcept override;

 private:
  [[nodiscard]] bool identify(const SpectrumSnapshot& snapshot, IdentificationResult& out) noexcept;

  Ends ends_;
  ModeIdentification& modes_;
};

}  // namespace app
