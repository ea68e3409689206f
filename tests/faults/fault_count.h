#pragma once

#include <array>
#include <cstdint>

// What the preloaded library (fault_calls.cpp) leaves in its file; fault_runs.py reads it.
struct FaultCount {
  std::uint64_t n_calls = 0;     // calls counted
  std::uint64_t n_failed = 0;    // of them, made to fail
  std::int64_t call = 0;         // number of the first one that failed; -1: the allocator
  std::uint64_t place = 0;       // of an allocation, its address in its library
  std::array<char, 224> what{};  // path or symbol of the first one that failed
};
