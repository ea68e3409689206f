#pragma once

#include <cstdint>
#include <string_view>

namespace core::simulation {

// Random numbers that depend on (seed, name, index) only: xoshiro256++ seeded through splitmix64. Each effect has its
// own stream, so that switching an effect off, or drawing more numbers for it, leaves all others unchanged. The
// arithmetic uses only IEEE add, multiply, divide and square root: bit-identical on every platform and standard
// library.
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

// Mixes the bits of one word; a good hash for indices.
[[nodiscard]] std::uint64_t mix64(std::uint64_t word) noexcept;
[[nodiscard]] std::uint64_t hash_name(std::string_view name) noexcept;

}  // namespace core::simulation
