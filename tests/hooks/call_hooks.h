#pragma once

#include <cstdint>
#include <string>
#include <vector>

// This executable's own malloc and pthread_mutex_lock (and their kin), for every library in it: they count, by thread,
// what a thread whose name begins with "hm-" does while counting is on, and then do what libc does.
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
  std::string through;     // innermost function of ours on the way there; may be empty
  bool in_opencv = false;  // a library of OpenCV (or what it is linked to) stands between us and the call
  std::uint64_t n = 0;
};

void start_counting();
void stop_counting() noexcept;
[[nodiscard]] std::vector<ThreadCalls> thread_calls();  // after stop_counting()
[[nodiscard]] std::vector<CallSite> call_sites();       // after stop_counting(); most frequent first

}  // namespace hooks
