#pragma once

#include <pthread.h>

#include <cstddef>
#include <functional>
#include <string>

namespace rt {

struct ThreadConfig {
  std::string name;                // shown by top -H; at most 15 characters are kept
  int fifo_priority = 0;           // SCHED_FIFO 1..99; 0 = ordinary scheduling
  int cpu = -1;                    // pin to this CPU; -1 = any
  std::size_t stack_bytes = 0;     // 0 = the system's default (ulimit -s)
  std::size_t prefault_bytes = 0;  // of the stack, touched before the body runs

  [[nodiscard]] bool is_special() const noexcept { return fifo_priority > 0 || cpu >= 0; }
};

// A thread whose policy, affinity and stack are set through its attributes, so that a refusal is an error in the
// starting thread.
class RtThread {
 public:
  RtThread() = default;
  ~RtThread();
  RtThread(const RtThread&) = delete;
  RtThread& operator=(const RtThread&) = delete;

  // Throws std::system_error: EPERM when the priority is refused (raise RLIMIT_RTPRIO or grant CAP_SYS_NICE), EINVAL
  // for a CPU that does not exist or a stack that is too small.
  void start(const ThreadConfig& config, std::function<void()> body);
  void join() noexcept;

 private:
  pthread_t handle_{};
  bool running_ = false;
};

}  // namespace rt
