#pragma once

#include <cstddef>
#include <string>

namespace rt {

// Locks all present and future pages of the process into memory, so that no page fault delays a stage. Returns an empty
// text, or why it was refused and how to allow it.
[[nodiscard]] std::string lock_memory();

// Freed memory stays with the process, and large blocks come from the heap instead of new pages: after set-up has used
// the memory once, it is mapped for the run path. Process-wide; call it before set-up.
void keep_freed_memory() noexcept;

// The opposite: blocks of half a megabyte or more come from new pages, which go back to the system when they are freed;
// otherwise the heap keeps them, in pieces, wherever a thread has once used much memory. All threads share one heap:
// each of its own would keep what its thread once needed. Process-wide; call it before other threads allocate.
void give_back_large_blocks() noexcept;

// Touches `n_bytes` of the calling thread's stack, so that its first deep call causes no page fault; fewer if the stack
// is smaller. May allocate: for a thread's set-up only.
void prefault_stack(std::size_t n_bytes) noexcept;

}  // namespace rt
