#pragma once

#include <atomic>
#include <cstdint>
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
  // Any thread: leave after the current step, finished or not. For stages before a faulted one, whose output is no
  // longer read. Partner: run().
  void abort() noexcept;

  [[nodiscard]] Stage& stage() noexcept { return stage_; }
  [[nodiscard]] const Stage& stage() const noexcept { return stage_; }
  [[nodiscard]] const ThreadConfig& config() const noexcept { return config_; }
  // Set-up only: use ordinary scheduling on any CPU, after the real-time settings were refused.
  void be_ordinary() noexcept { config_.fifo_priority = 0, config_.cpu = -1; }
  // Set-up only: a step (or finish()) that takes longer is a stall. More than the 100 ms of an idle wait.
  void set_stall_limit_ns(std::int64_t limit_ns) noexcept { stall_limit_ns_ = limit_ns; }
  // Any thread: how long the stage has been in one step, or waiting for its next (at most 100 ms); 0: it has ended.
  [[nodiscard]] std::int64_t in_step_for_ns(std::int64_t now_ns) const noexcept;
  // Any thread: how long the stage has been in one step, if that exceeds its limit; else 0. An idle stage checks
  // for work ten times a second and does not stall.
  [[nodiscard]] std::int64_t stalled_for_ns(std::int64_t now_ns) const noexcept;
  // Any thread: CLOCK_MONOTONIC at the end of its last step; 0 = not ended. finish() runs after that.
  [[nodiscard]] std::int64_t steps_ended_ns() const noexcept { return steps_ended_ns_.load(std::memory_order_relaxed); }
  // Any thread. release in run(), acquire here: the stage's description of its fault is visible.
  [[nodiscard]] bool faulted() const noexcept { return faulted_.load(std::memory_order_acquire); }
  [[nodiscard]] bool finished() const noexcept { return finished_.load(std::memory_order_acquire); }

 private:
  void run() noexcept;

  Stage& stage_;
  ThreadConfig config_;
  std::int64_t stall_limit_ns_ = INT64_MAX;
  std::atomic<std::int64_t> step_began_ns_{0};   // written by run() only; relaxed: independent; 0 = not started
  std::atomic<std::int64_t> steps_ended_ns_{0};  // written by run() only; relaxed: independent of other data
  std::atomic<bool> aborted_{false};
  std::atomic<bool> faulted_{false};
  std::atomic<bool> finished_{false};
  RtThread thread_;  // last member: joined before the flags are destroyed
};

}  // namespace rt
