#include "rt/stage_runner.h"

#include <chrono>
#include <utility>

#include "rt/clock.h"

namespace rt {

namespace {
// A nudge ends the wait; this only bounds what a lost nudge (our own bug) could cost, and paces the status report.
constexpr std::chrono::milliseconds kIdleTimeout{100};
}  // namespace

StageRunner::StageRunner(Stage& stage, ThreadConfig config) : stage_(stage), config_(std::move(config)) {}

void StageRunner::start() {
  thread_.start(config_, [this] { run(); });
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
    const StepStatus status = stage_.step();
    if (status == StepStatus::kIdle) {
      stage_.wakeup().wait(ticket, kIdleTimeout);
      continue;
    }
    const auto step_ns = static_cast<std::uint64_t>(monotonic_ns() - begin_ns);
    StageStats::add(stats.busy_ns, step_ns);
    StageStats::raise(stats.worst_step_ns, step_ns);
    if (status == StepStatus::kWorked) continue;
    if (status == StepStatus::kFault) faulted_.store(true, std::memory_order_release);
    break;
  }
  stage_.finish();
  finished_.store(true, std::memory_order_release);
}

}  // namespace rt
