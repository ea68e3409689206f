#include "rt/stage_runner.h"

#include <chrono>
#include <utility>

#include "rt/clock.h"

namespace rt {

namespace {
// A wake-up ends the wait; this limits the effect of a lost wake-up (a fault of this program), and paces the status.
constexpr std::chrono::milliseconds kIdleTimeout{100};
}  // namespace

StageRunner::StageRunner(Stage& stage, ThreadConfig config) : stage_(stage), config_(std::move(config)) {}

void StageRunner::start() {
  thread_.start(config_, [this] { run(); });
}

std::int64_t StageRunner::in_step_for_ns(std::int64_t now_ns) const noexcept {
  const std::int64_t began_ns = step_began_ns_.load(std::memory_order_relaxed);
  return began_ns == 0 || finished() ? 0 : now_ns - began_ns;
}

std::int64_t StageRunner::stalled_for_ns(std::int64_t now_ns) const noexcept {
  const std::int64_t for_ns = in_step_for_ns(now_ns);
  return for_ns > stall_limit_ns_ ? for_ns : 0;
}

void StageRunner::abort() noexcept {
  aborted_.store(true, std::memory_order_release);
  stage_.wakeup().nudge();
}

void StageRunner::run() noexcept {
  StageStats& stats = stage_.stats();
  while (!aborted_.load(std::memory_order_acquire)) {
    const Wakeup::Ticket ticket = stage_.wakeup().ticket();
    const std::int64_t begin_ns = monotonic_ns();
    step_began_ns_.store(begin_ns, std::memory_order_relaxed);
    const StepStatus status = stage_.step();
    if (status == StepStatus::kIdle) {
      stage_.wakeup().wait(ticket, kIdleTimeout);
      continue;
    }
    const std::int64_t step_ns = monotonic_ns() - begin_ns;
    StageStats::add(stats.busy_ns, static_cast<std::uint64_t>(step_ns));
    stats.step.add(step_ns);
    stats.cpu_ns.store(static_cast<std::uint64_t>(thread_cpu_ns()), std::memory_order_relaxed);
    if (status == StepStatus::kWorked) continue;
    if (status == StepStatus::kFault) faulted_.store(true, std::memory_order_release);
    break;
  }
  steps_ended_ns_.store(monotonic_ns(), std::memory_order_relaxed);
  stage_.finish();
  finished_.store(true, std::memory_order_release);
}

}  // namespace rt
