#pragma once

#include <array>
#include <cstddef>

#include "core/tracking/klt/phase.h"

namespace core {

// Fits polynomials of two variables to values at kPoints places, by weighted least squares. Plain loops in a fixed
// order: bit-identical on every machine.
template <int kDegree, std::size_t kPoints>
class SurfaceFit {
 public:
  using Values = std::array<double, kPoints>;

  constexpr SurfaceFit(const Values& a, const Values& b, const Values& weights) noexcept {
    for (std::size_t p = 0; p < kPoints; ++p) {
      const auto terms = Polynomial<kDegree>::terms(a[p], b[p]);
      for (std::size_t k = 0; k < kTerms; ++k) weighted_[p][k] = weights[p] * terms[k];
      for (std::size_t k = 0; k < kTerms; ++k)
        for (std::size_t l = 0; l <= k; ++l) factor_[k][l] += weighted_[p][k] * terms[l];
    }
    for (std::size_t k = 0; k < kTerms; ++k) {  // L D L^T
      const double whole = factor_[k][k];
      std::array<double, kTerms> scaled{};
      for (std::size_t l = 0; l < k; ++l) {
        double value = factor_[k][l];
        for (std::size_t i = 0; i < l; ++i) value -= scaled[i] * factor_[l][i];
        scaled[l] = value;
        factor_[k][l] = value * inverse_pivot_[l];
        factor_[k][k] -= value * factor_[k][l];
      }
      is_determined_ = is_determined_ && factor_[k][k] > kLeastPivot * whole;
      inverse_pivot_[k] = factor_[k][k] > 0.0 ? 1.0 / factor_[k][k] : 0.0;
    }
  }

  // False: the places do not determine the polynomials.
  [[nodiscard]] constexpr bool is_determined() const noexcept { return is_determined_; }
  [[nodiscard]] Polynomial<kDegree> to(const Values& values) const noexcept {
    Polynomial<kDegree> out;
    auto& x = out.factors;
    for (std::size_t p = 0; p < kPoints; ++p)
      for (std::size_t k = 0; k < kTerms; ++k) x[k] += weighted_[p][k] * values[p];
    for (std::size_t k = 0; k < kTerms; ++k)
      for (std::size_t l = k + 1; l < kTerms; ++l) x[l] -= factor_[l][k] * x[k];
    for (std::size_t k = 0; k < kTerms; ++k) x[k] *= inverse_pivot_[k];
    for (std::size_t k = kTerms; k-- > 0;)
      for (std::size_t l = 0; l < k; ++l) x[l] -= factor_[k][l] * x[k];
    return out;
  }

 private:
  static constexpr std::size_t kTerms = Polynomial<kDegree>::kTerms;
  static constexpr double kLeastPivot = 1e-12;

  std::array<std::array<double, kTerms>, kPoints> weighted_{};
  std::array<std::array<double, kTerms>, kTerms> factor_{};  // unit lower triangle
  std::array<double, kTerms> inverse_pivot_{};
  bool is_determined_ = true;
};

}  // namespace core
