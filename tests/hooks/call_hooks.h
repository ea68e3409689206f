#pragma once

#include <cstdint>
#include <string>
#include <vector>

// Replaces malloc and pthread_mutex_lock (and related functions) in this executable, for every library in it: they
// count, per thread, the calls of threads whose name begins with "hm-" while counting is on, and then call libc's.
namespace hooks {

struct ThreadCalls {
  std::string thread;
  std::uint64_t n_allocations = 0, n_frees = 0;
  std::uint64_t n_locks = 0, n_waits = 0;  // mutexes and rwlocks; condition variables
};

// One place that allocates or locks.
struct CallSite {
  std::string thread;
  std::string what;     // "allocation", "lock", "wait"
  std::string library;  // of the innermost frame that is neither libc, libstdc++ nor this hook
  std::string function;
  std::string through;     // innermost function of this project in the call chain; may be empty
  bool in_opencv = false;  // a library of OpenCV (or one it is linked to) lies between this project and the call
  std::uint64_t n = 0;
};

void start_counting();
void stop_counting() noexcept;
[[nodiscard]] std::vector<ThreadCalls> thread_calls();  // after stop_counting()
[[nodiscard]] std::vector<CallSite> call_sites();       // after stop_counting(); most frequent first

}  // namespace hooks
