#pragma once

#include <csignal>

namespace tools {

// Checked by commands that run until stopped; set by SIGINT, SIGTERM and SIGHUP.
inline volatile std::sig_atomic_t stop_requested = 0;

inline void watch_stop_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { stop_requested = 1; };
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // ignored under nohup
}

}  // namespace tools
