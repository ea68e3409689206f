#pragma once

#include <atomic>
#include <string>

#include "rt/rt_thread.h"
#include "rt/stage.h"

namespace rt {

// Runs one stage on its thread until it finishes: step while there is work, wait on the stage's wakeup when idle.
class StageRunner {
 public:
  StageRunner(Stage& stage, ThreadConfig config);
  ~StageRunner() { join(); }

  // Throws std::system_error when the thread or its priority is refused.
  void start();
  void join() noexcept { thread_.join(); }
  // Any thread: leave after the current step, finished or not. For stages before a faulted one, whose output has no
  // reader any more. Partner: run().
  void abort() noexcept;

  [[nodiscard]] Stage& stage() noexcept { return stage_; }
  [[nodiscard]] const ThreadConfig& config() const noexcept { return config_; }
  void drop_priority() noexcept { config_.fifo_priority = 0; }
  // Any thread. release in run(), acquire here: what the stage wrote about its fault is visible.
  [[nodiscard]] bool faulted() const noexcept { return faulted_.load(std::memory_order_acquire); }
  [[nodiscard]] bool finished() const noexcept { return finished_.load(std::memory_order_acquire); }

 private:
  void run() noexcept;

  Stage& stage_;
  ThreadConfig config_;
  std::atomic<bool> aborted_{false};
  std::atomic<bool> faulted_{false};
  std::atomic<bool> finished_{false};
  RtThread thread_;  // last: joined before the flags go
};

}  // namespace rt
