#pragma once

#include <csignal>
#include <cstdint>
#include <string>
#include <vector>

#include "firmware_app/service/pipeline.h"

namespace app {

// SIGINT, SIGTERM and SIGHUP, blocked for the whole process and polled by the main thread. Construct before any thread.
class SignalWatch {
 public:
  SignalWatch();
  // Waits up to 50 ms for a signal; this sets the main thread's pace.
  [[nodiscard]] bool stop_requested() const noexcept;

 private:
  sigset_t signals_{};
};

// Terminal output: source and channels, a line at intervals, the modes at the end. Main thread.
class Progress {
 public:
  explicit Progress(Pipeline& pipeline);
  void started();   // reports facts that were not available to start()
  void stopping();  // a stop has just been requested
  void tick();
  // Prints the result; true when the run ended without fault.
  [[nodiscard]] bool finish(const Pipeline::Outcome& outcome);

 private:
  void print_stall();

  Pipeline& pipeline_;
  std::int64_t start_ns_;
  std::int64_t next_line_ns_;
  std::int64_t stop_ns_ = 0;       // 0: not requested
  std::vector<std::string> told_;  // warnings already printed
  bool stalled_ = false;
};

}  // namespace app
