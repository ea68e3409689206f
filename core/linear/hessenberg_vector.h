#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include "core/linear/francis_qr.h"

namespace core {

// Eigenvectors of an upper Hessenberg matrix by one step of inverse iteration: with H - lambda I = P L U, solves U x =
// L^-1 P^T b, with b chosen so that the right-hand side is a vector of ones (EISPACK's invit). Borrows the matrix.
class HessenbergVector {
 public:
  explicit HessenbergVector(const RowMatrix& h);

  void compute(std::complex<double> lambda);                                      // an eigenvalue
  [[nodiscard]] const std::vector<double>& re() const noexcept { return x_re_; }  // of unit norm
  [[nodiscard]] const std::vector<double>& im() const noexcept { return x_im_; }

 private:
  double* re(int i) noexcept { return re_.data() + static_cast<std::ptrdiff_t>(i) * h_.n; }
  double* im(int i) noexcept { return im_.data() + static_cast<std::ptrdiff_t>(i) * h_.n; }
  void factor(std::complex<double> lambda);
  void substitute();
  [[nodiscard]] std::complex<double> product(int k);            // sum over j > k of U(k, j) x(j)
  [[nodiscard]] std::complex<double> exchanged_product(int k);  // the same if row k of U is row k + 1 of H - lambda I

  const RowMatrix& h_;
  double norm_ = 0.0;
  std::complex<double> lambda_;
  std::vector<std::uint8_t> exchanged_;
  std::vector<double> re_, im_, x_re_, x_im_;
};

}  // namespace core
