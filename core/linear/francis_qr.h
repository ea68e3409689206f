#pragma once

#include <complex>
#include <vector>

namespace core {

// Square matrix, row-major.
struct RowMatrix {
  int n = 0;
  std::vector<double> values;

  [[nodiscard]] double* row(int i) noexcept { return values.data() + static_cast<std::ptrdiff_t>(i) * n; }
  [[nodiscard]] const double* row(int i) const noexcept { return values.data() + static_cast<std::ptrdiff_t>(i) * n; }
};

// Eigenvalues of an upper Hessenberg matrix by Francis' double-shift QR (EISPACK's hqr: Martin, Peters & Wilkinson
// 1970). h is destroyed. False if the iteration does not converge.
[[nodiscard]] bool hessenberg_values(RowMatrix& h, std::vector<std::complex<double>>& values);

}  // namespace core
