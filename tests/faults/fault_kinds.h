#pragma once

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <string_view>

#include "tests/faults/fault_count.h"

namespace faults {

// Which calls a kind counts: bits.
enum Calls : unsigned {
  kRead = 1U,     // read, pread64, readv
  kWrite = 2U,    // write, pwrite64, writev
  kOpen = 4U,     // open, openat, and other calls that make a descriptor
  kGrow = 8U,     // fallocate, ftruncate, mkdir, rename, link: need space
  kRemove = 16U,  // unlink, rmdir
  kSync = 32U,    // fsync, fdatasync
  kClose = 64U,
  kLook = 128U,  // stat, access, getdents
  kLock = 256U,
  kMemory = 512U
};

struct Kind {
  std::string_view name;
  unsigned calls;
  int error;          // 0: not an error, see fail()
  bool goes_on;       // all later ones fail, too
  bool needs_change;  // of kOpen only those that write
};
inline constexpr std::array kKinds{
    Kind{"enospc", kWrite | kOpen | kGrow | kSync, ENOSPC, true, true},        // the disk fills up, for good
    Kind{"enospc_once", kWrite | kOpen | kGrow | kSync, ENOSPC, false, true},  // and is freed again
    Kind{"eio", kRead | kWrite | kOpen | kGrow | kRemove | kSync | kClose | kLook, EIO, true, false},
    Kind{"eio_once", kRead | kWrite | kOpen | kGrow | kRemove | kSync | kClose | kLook, EIO, false, false},
    Kind{"eintr", kRead | kWrite | kOpen | kSync | kClose | kLock, EINTR, false, false},
    Kind{"short", kRead | kWrite, 0, false, false},  // half of what was asked for
    Kind{"emfile", kOpen, EMFILE, false, false},
    Kind{"enomem", kMemory, ENOMEM, false, false},
    Kind{"enomem_thrown", kMemory, ENOMEM, false, false},                   // as where the program's reserve is used up
    Kind{"slow", kWrite | kOpen | kGrow | kSync | kRead, 0, false, false},  // 300 ms
    Kind{"erofs", kWrite | kOpen | kGrow | kRemove, EROFS, true, true}};    // mounted read-only from then on

// Of this process.
inline const Kind* kind = nullptr;
inline std::uint64_t nth = 0;
inline FaultCount own_count;
inline FaultCount* count = &own_count;
inline std::atomic<bool> is_counting{false};
// Of FaultCount::n_calls; relaxed: independent of other data.
inline std::atomic<std::uint64_t> n_calls{0};

inline std::uint64_t next_number() {
  const std::uint64_t n = n_calls.fetch_add(1, std::memory_order_relaxed) + 1;
  count->n_calls = n;
  return n;
}
inline bool is_hit(std::uint64_t n) { return nth != 0 && (n == nth || (kind->goes_on && n > nth)); }

}  // namespace faults
