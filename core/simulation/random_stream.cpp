#include "core/simulation/random_stream.h"

#include <bit>
#include <cmath>

#include "core/types/fnv1a.h"

namespace core::simulation {
namespace {

constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ULL;

// ln(x) for 0 < x < 1. The library's log may differ in the last bit between platforms; this one does not. Atanh series
// of the mantissa in [sqrt(1/2), sqrt(2)): the first omitted term is below 1e-18.
double portable_log(double x) noexcept {
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  if (mantissa < 0.70710678118654752) {
    mantissa *= 2.0;
    --exponent;
  }
  const double s = (mantissa - 1.0) / (mantissa + 1.0);
  const double s2 = s * s;
  double sum = 0.0;
  for (int n = 21; n >= 1; n -= 2) sum = sum * s2 + 1.0 / n;
  return 2.0 * s * sum + exponent * 0.69314718055994531;
}

}  // namespace

std::uint64_t mix64(std::uint64_t word) noexcept {
  word += kGolden;
  word = (word ^ (word >> 30)) * 0xBF58476D1CE4E5B9ULL;
  word = (word ^ (word >> 27)) * 0x94D049BB133111EBULL;
  return word ^ (word >> 31);
}

std::uint64_t hash_name(std::string_view name) noexcept { return fnv1a(name); }

RandomStream::RandomStream(std::uint64_t seed, std::string_view name, std::uint64_t index) noexcept {
  std::uint64_t word = mix64(mix64(mix64(seed) ^ hash_name(name)) + index);
  for (auto& s : state_) {
    s = mix64(word);
    word += kGolden;
  }
}

std::uint64_t RandomStream::next() noexcept {
  const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
  const std::uint64_t t = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= t;
  state_[3] = std::rotl(state_[3], 45);
  return result;
}

double RandomStream::uniform() noexcept { return static_cast<double>(next() >> 11) * 0x1.0p-53; }

// Marsaglia's polar method, which needs no sine or cosine.
double RandomStream::gaussian() noexcept {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  double x = 0.0, y = 0.0, r2 = 0.0;
  do {
    x = 2.0 * uniform() - 1.0;
    y = 2.0 * uniform() - 1.0;
    r2 = x * x + y * y;
  } while (r2 >= 1.0 || r2 == 0.0);
  const double factor = std::sqrt(-2.0 * portable_log(r2) / r2);
  spare_ = y * factor;
  has_spare_ = true;
  return x * factor;
}

}  // namespace core::simulation
