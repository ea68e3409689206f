#pragma once

#include <atomic>
#include <mutex>
#include <string>

#include "firmware_app/chain/state/run_state.h"
#include "firmware_app/service/stages/items.h"
#include "rt/stage.h"
#include "rt/triple_buffer.h"

namespace app {

// newest sums and modes -> the state file. Runs at ordinary priority on a thread of its own, because a disk may take
// its time; nobody waits for it. A write that fails is counted, told, and tried again with the next state.
class CheckpointStage : public rt::Stage {
 public:
  // view: what is fixed over the run; its spectrum and modes are filled here. path empty: nothing is written.
  CheckpointStage(rt::TripleBuffer<StateBytes>& spectrum, rt::TripleBuffer<StateBytes>& modes, RunState view,
                  std::string path)
      : spectrum_(spectrum), modes_(modes), state_(std::move(view)), path_(std::move(path)) {}

  [[nodiscard]] std::string_view name() const noexcept override { return "checkpoint"; }
  [[nodiscard]] rt::StepStatus step() noexcept override;

  // Any thread: why the last write failed; empty: it did not.
  [[nodiscard]] std::string failure() const;

 private:
  rt::TripleBuffer<StateBytes>& spectrum_;
  rt::TripleBuffer<StateBytes>& modes_;
  RunState state_;
  std::string path_;
  mutable std::mutex mutex_;  // of failure_; neither side is a real-time thread
  std::string failure_;
};

}  // namespace app
