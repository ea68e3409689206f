#pragma once

#include <cstdint>
#include <string_view>

#include "rt/event_log.h"
#include "rt/stage_stats.h"
#include "rt/wakeup.h"

namespace rt {

enum class StepStatus : std::uint8_t { kWorked, kIdle, kFinished, kFault };

// One step of the data flow, on its own thread. A stage takes from a ring, calls one object, puts into a ring.
class Stage {
 public:
  virtual ~Stage() = default;
  [[nodiscard]] virtual std::string_view name() const noexcept = 0;
  [[nodiscard]] virtual StepStatus step() noexcept = 0;  // at most one item, bounded time
  virtual void finish() noexcept {}                      // after the last step, same thread: flush, close the outputs

  // Notified by the rings around this stage; the runner waits on it after kIdle.
  [[nodiscard]] Wakeup& wakeup() noexcept { return wakeup_; }
  [[nodiscard]] StageStats& stats() noexcept { return stats_; }
  [[nodiscard]] const StageStats& stats() const noexcept { return stats_; }
  // Written by the stage's thread; read by the one thread that prints.
  [[nodiscard]] EventLog& events() noexcept { return events_; }

 private:
  Wakeup wakeup_;
  StageStats stats_;
  EventLog events_;
};

}  // namespace rt
