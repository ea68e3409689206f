#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace tools {

// What the command line of hovermodal-validate states.
struct ValidateOptions {
  std::string what;
  int n_seeds = 20, n_frames = 40, n_threads = 2;
  double duration_s = 0.0, strength = 0.0;
  int first_seed = 1;
  std::string flight, report, effect;

  [[nodiscard]] std::uint64_t seed() const noexcept { return static_cast<std::uint64_t>(first_seed); }
};

// Options that a check may take; all others are refused.
enum CheckTakes : unsigned {
  kSeed = 1,  // --first-seed
  kSeeds = 2,
  kFrames = 4,
  kThreads = 8,
  kDuration = 16,
  kEffect = 32,
  kStrength = 64,
  kFlight = 128,
  kReport = 256,
  kRecords = kSeed | kSeeds | kThreads,
  kFlights = kRecords | kDuration | kFlight
};

struct Check {
  const char *name, *meaning;
  void (*print)(const ValidateOptions&);
  unsigned takes;
};
[[nodiscard]] std::span<const Check> all_checks() noexcept;

}  // namespace tools
