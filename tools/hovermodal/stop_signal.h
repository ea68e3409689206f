#pragma once

#include <csignal>

namespace tools {

// What a command that runs until it is stopped looks at: SIGINT and SIGTERM ask it to end.
inline volatile std::sig_atomic_t stop_requested = 0;

inline void watch_stop_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { stop_requested = 1; };
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace tools
