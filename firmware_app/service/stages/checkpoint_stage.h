#pragma once

#include <atomic>
#include <mutex>
#include <string>

#include "firmware_app/chain/state/run_state.h"
#include "firmware_app/service/stages/items.h"
#include "rt/stage.h"
#include "rt/triple_buffer.h"

namespace app {

// newest sums and modes -> the state file. Runs at ordinary priority in a thread of its own, because a disk may be
// slow; no other stage waits for it. A write that fails is counted, reported, and repeated with the next state.
class CheckpointStage : public rt::Stage {
 public:
  // view: the constants of the run; spectrum and modes are filled in here. path empty: nothing is written.
  CheckpointStage(rt::TripleBuffer<StateBytes>& spectrum, rt::TripleBuffer<StateBytes>& modes, RunState view,
                  std::string path)
      : spectrum_(spectrum), modes_(modes), state_(std::move(view)), path_(std::move(path)) {}

  // Before the thread starts: the modes that a resumed run goes on with, written until its first estimate replaces
  // them.
  void go_on_with(const std::vector<std::uint8_t>& modes) { state_.modes = modes; }

  [[nodiscard]] std::string_view name() const noexcept override { return "checkpoint"; }
  [[nodiscard]] rt::StepStatus step() noexcept override;

  // Any thread: why the last write failed; empty: it succeeded.
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
