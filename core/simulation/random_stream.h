#pragma once

#include <cstdint>
#include <string_view>

namespace core::simulation {

// Random numbers that depend on (seed, name, index) only: xoshiro256++ seeded through splitmix64. One stream per
// effect, so that switching an effect off, or drawing more from it, leaves every other effect as it was. The arithmetic
// uses nothing but IEEE add, multiply, divide and square root: the same bits on every platform and standard library.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name, std::uint64_t index = 0) noexcept;

  std::uint64_t next() noexcept;  // 64 random bits
  double uniform() noexcept;      // [0, 1)
  double gaussian() noexcept;     // mean 0, variance 1

 private:
  std::uint64_t state_[4];
  double spare_ = 0.0;
  bool has_spare_ = false;
};

// Scrambles one word; a good hash for indices.
[[nodiscard]] std::uint64_t mix64(std::uint64_t word) noexcept;
[[nodiscard]] std::uint64_t hash_name(std::string_view name) noexcept;

}  // namespace core::simulation
