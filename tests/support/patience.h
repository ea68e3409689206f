#pragma once

namespace tests {

// By how much limits of time are stretched: code that a sanitizer has instrumented is some ten times slower.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr int kSlowdown = 20;
#else
inline constexpr int kSlowdown = 1;
#endif

}  // namespace tests
