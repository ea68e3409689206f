#pragma once

#include <csignal>
#include <cstdint>

#include "firmware_app/pipeline.h"

namespace app {

// SIGINT and SIGTERM, blocked for the whole process and asked for by the main thread. Construct before any thread.
class SignalWatch {
 public:
  SignalWatch();
  // Waits up to 50 ms for a signal: the main thread's pace.
  [[nodiscard]] bool stop_requested() const noexcept;

 private:
  sigset_t signals_{};
};

// What the person at the terminal sees: source and channels, a line now and then, the modes at the end. Main thread.
class Progress {
 public:
  explicit Progress(const Pipeline& pipeline);
  void tick();
  // Prints the result; true when the run ended without fault.
  [[nodiscard]] bool finish(const Pipeline::Outcome& outcome) const;

 private:
  const Pipeline& pipeline_;
  std::int64_t start_ns_;
  std::int64_t next_line_ns_;
};

}  // namespace app
