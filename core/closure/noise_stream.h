#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace core::closure {

// Seeded numbers for surrogates. The C++ standard defines the generator and this code the polar method
// (Marsaglia & Bray 1964), so the numbers are the same with every standard library.
class NoiseStream {
 public:
  explicit NoiseStream(std::uint64_t seed) : engine_(seed) {}

  double uniform() { return static_cast<double>(engine_() >> 11U) * 0x1.0p-53; }  // [0, 1)

  double gaussian() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    double x = 0.0, y = 0.0, square = 0.0;
    do {
      x = 2.0 * uniform() - 1.0;
      y = 2.0 * uniform() - 1.0;
      square = x * x + y * y;
    } while (square >= 1.0 || square == 0.0);
    const double factor = std::sqrt(-2.0 * std::log(square) / square);
    spare_ = y * factor;
    has_spare_ = true;
    return x * factor;
  }

 private:
  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace core::closure
