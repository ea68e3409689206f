#pragma once

#include <array>
#include <cstdint>

#include "core/tracking/klt/deformation.h"
#include "core/tracking/klt/patch.h"

namespace core {

// Polynomial of two variables: the sum of factors times a^i b^j, i + j <= kDegree, in order of i, then j.
template <int kDegree>
struct Polynomial {
  static constexpr std::size_t kTerms = (kDegree + 1) * (kDegree + 2) / 2;
  std::array<double, kTerms> factors{};

  [[nodiscard]] double of(const Vector2& at) const noexcept {
    double sum = 0.0;
    std::size_t end = kTerms;
    for (std::size_t n = 1; n <= kDegree + 1; ++n) {  // so many powers of b go with this one of a
      double of_b = factors[--end];
      for (std::size_t j = 1; j < n; ++j) of_b = of_b * at.v + factors[--end];
      sum = sum * at.u + of_b;
    }
    return sum;
  }
  // The terms without their factors.
  [[nodiscard]] static constexpr std::array<double, kTerms> terms(double a, double b) noexcept {
    std::array<double, kTerms> out{};
    std::size_t at = 0;
    double of_a = 1.0;
    for (int i = 0; i <= kDegree; ++i, of_a *= a) {
      double term = of_a;
      for (int j = 0; i + j <= kDegree; ++j, term *= b) out[at++] = term;
    }
    return out;
  }
};

// Arguments of a phase's polynomials per pixel: about 1 at the ends of their range.
inline constexpr double kPlaceScale = 3.0;

// A template at one place within a pixel, ready for the raw pixels of an image. With I the image's window at a whole
// pixel, d the displacement of the texture from this phase, g the light's gain:
//   step = sum_x S(x) I(x) = g s(d)      S is orthogonal to the template and to a constant
//   match = sum_x T(x) I(x) = g |T|^2 c(d)
// s, c and the energy that is orthogonal to T follow from the template alone.
struct Phase {
  using Factors = std::array<std::int16_t, kWindowSize>;

  alignas(64) Factors step_u{}, step_v{}, texture{};
  double px_per_unit = 0.0, grey_per_unit = 0.0;                 // scales of the sums
  double sum_step_u = 0.0, sum_step_v = 0.0, sum_texture = 0.0;  // over the factors, in units
  double square = 0.0;                                           // |T|^2, grey^2
  // In multiples of kPlaceScale: d from s, px; c(d) |T|^2, without the template's noise, and the energy of the
  // displaced template orthogonal to T, from d, grey^2.
  Polynomial<4> place_u, place_v;
  Polynomial<4> similarity, aside;
  double passed_noise = 1.0;                  // variance of the template's white noise in this phase
  double variance_u = 0.0, variance_v = 0.0;  // of s for white noise of variance 1 in the image, px^2
  DeformationPull pull{};
};

// Phases lie a third of a pixel apart.
inline constexpr int kPhasesPerPixel = 3;

}  // namespace core
