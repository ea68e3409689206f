// Memory of the spectral accumulator: bytes before and after, and allocations during, N samples of 12 channels.
//   accumulator_memory [SAMPLES] [SEED]    by default 10^7; exit code 1 when anything was allocated or the heap grew
#include <malloc.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "core/simulation/random_stream.h"
#include "core/spectrum/welch_cpsd.h"
#include "tests/support/alloc_guard.h"

namespace {

constexpr int kChannels = 12;

std::size_t heap_bytes() { return mallinfo2().uordblks + mallinfo2().hblkhd; }

long resident_kib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmRSS:")) return std::strtol(line.c_str() + 6, nullptr, 10);
  }
  return 0;
}

void push_noise(core::WelchCpsd& welch, core::simulation::RandomStream& noise, long n_samples) {
  std::array<double, kChannels> value{};
  std::array<std::uint8_t, kChannels> seen{};
  for (long t = 0; t < n_samples; ++t) {
    const std::uint64_t lost = noise.next();  // one channel sample in 64 is masked
    for (std::size_t c = 0; c < kChannels; ++c) {
      value[c] = noise.uniform();
      seen[c] = ((lost >> (4 * c)) & 63U) == 0 ? 0 : 1;
    }
    welch.push(value, seen);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const long n_samples = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 10'000'000;
  core::simulation::RandomStream noise(argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1, "accumulator");
  const std::size_t bytes_without = heap_bytes();
  core::WelchCpsd welch({.n_channels = kChannels, .segment = 1024, .rate_hz = 30.0});
  push_noise(welch, noise, 2048);                   // touches every page once
  const long resident_before_kib = resident_kib();  // called first, because reading it allocates once
  const std::size_t bytes_before = heap_bytes();
  std::size_t n_calls = 0;
  {
    const test_support::AllocGuard guard;
    push_noise(welch, noise, n_samples);
    n_calls = guard.n_new() + guard.n_delete();
  }
  const std::size_t bytes_after = heap_bytes();
  std::printf("accumulator\t%ld samples\t%d channels\t%zu bytes\n", n_samples, kChannels, bytes_before - bytes_without);
  std::printf("heap\t%zu bytes before\t%zu bytes after\n", bytes_before, bytes_after);
  std::printf("resident\t%ld KiB before\t%ld KiB after\n", resident_before_kib, resident_kib());
  std::printf("allocations\t%zu\n", n_calls);
  return n_calls == 0 && bytes_after == bytes_before ? 0 : 1;
}
