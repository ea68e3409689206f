#pragma once

#include <complex>
#include <span>
#include <vector>

namespace core {

// Planned discrete Fourier transform of real data, length a power of two >= 4. Does not allocate after construction.
// Forward: X[k] = sum_t x[t] exp(-2 pi i k t / n), k = 0 .. n/2. Inverse: divides by n, so that it inverts forward.
// A real transform is one complex transform of half the length (Press et al., Numerical Recipes, section 12.3).
// Bit-identical on every machine.
// Not thread-safe: the work space is a member.
class RealFft {
 public:
  explicit RealFft(int n);  // throws std::invalid_argument unless n is a power of two >= 4

  [[nodiscard]] int size() const noexcept { return n_; }
  [[nodiscard]] int n_bins() const noexcept { return n_ / 2 + 1; }
  void forward(std::span<const double> x, std::span<std::complex<double>> spectrum) noexcept;  // n -> n/2 + 1
  void inverse(std::span<const std::complex<double>> spectrum, std::span<double> x) noexcept;  // n/2 + 1 -> n

 private:
  void transform_half() noexcept;  // re_, im_, forward; re_to_, im_to_ are work space

  // One radix-4 pass (Stockham, self-sorting): n_points / 4 butterflies of `stride` adjacent elements each.
  struct Pass {
    int n_butterflies, stride;
    std::vector<double> twiddles;  // re, im of w, w^2, w^3, each n_butterflies long
  };

  int n_;
  int half_;
  std::vector<Pass> passes_;
  bool radix_two_last_ = false;                  // true if half_ is not a power of four
  std::vector<double> unit_re_, unit_im_;        // exp(-2 pi i k / n), k <= half
  std::vector<double> re_, im_, re_to_, im_to_;  // half elements each
};

// Smallest power of two >= n (n >= 1).
[[nodiscard]] int next_power_of_two(int n) noexcept;

}  // namespace core
