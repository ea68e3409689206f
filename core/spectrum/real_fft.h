#pragma once

#include <complex>
#include <span>
#include <vector>

namespace core {

// Planned discrete Fourier transform of real data, length a power of two >= 4. Nothing is allocated after construction.
// Forward: X[k] = sum_t x[t] exp(-2 pi i k t / n), k = 0 .. n/2. Inverse: exactly undoes forward (divides by n).
// A real transform is one complex transform of half the length (Press et al., Numerical Recipes, section 12.3).
// Not thread-safe: the work space is a member.
class RealFft {
 public:
  explicit RealFft(int n);  // throws std::invalid_argument when n is not a power of two >= 4

  [[nodiscard]] int size() const noexcept { return n_; }
  [[nodiscard]] int n_bins() const noexcept { return n_ / 2 + 1; }
  void forward(std::span<const double> x, std::span<std::complex<double>> spectrum) noexcept;  // n -> n/2 + 1
  void inverse(std::span<const std::complex<double>> spectrum, std::span<double> x) noexcept;  // n/2 + 1 -> n

 private:
  void transform_half() noexcept;  // work_ in place, forward

  int n_;
  int half_;
  std::vector<std::complex<double>> twiddle_half_;  // exp(-2 pi i k / half), k < half / 2
  std::vector<std::complex<double>> twiddle_full_;  // exp(-2 pi i k / n), k <= half
  std::vector<int> bit_reversed_;
  std::vector<std::complex<double>> work_;
};

// Smallest power of two >= n (n >= 1).
[[nodiscard]] int next_power_of_two(int n) noexcept;

}  // namespace core
