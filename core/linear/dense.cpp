#include "core/linear/dense.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/linear/vector_clones.h"

namespace core {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Ref;

// A tile of `a` (rows x inner) stays in the first-level cache while all columns of c are processed.
constexpr Index kTileRows = 96;
constexpr Index kTileInner = 32;
constexpr Index kStripColumns = 24;
constexpr Index kPackedColumns = 512;  // of b, copied at once
constexpr Index kLeastColumns = 8;     // with fewer columns: column by column

[[gnu::always_inline]] inline void add_columns(double* __restrict c0, double* __restrict c1, const double* __restrict a,
                                               Index lda, const double* b0, const double* b1, Index rows, Index inner) {
  Index k = 0;
  for (; k + 4 <= inner; k += 4) {
    const double* __restrict a0 = a + k * lda;
    const double* __restrict a1 = a0 + lda;
    const double* __restrict a2 = a1 + lda;
    const double* __restrict a3 = a2 + lda;
    const double p0 = b0[k], p1 = b0[k + 1], p2 = b0[k + 2], p3 = b0[k + 3];
    const double q0 = b1[k], q1 = b1[k + 1], q2 = b1[k + 2], q3 = b1[k + 3];
    for (Index i = 0; i < rows; ++i) {
      c0[i] = (((c0[i] + a0[i] * p0) + a1[i] * p1) + a2[i] * p2) + a3[i] * p3;
      c1[i] = (((c1[i] + a0[i] * q0) + a1[i] * q1) + a2[i] * q2) + a3[i] * q3;
    }
  }
  for (; k < inner; ++k) {
    const double* __restrict a0 = a + k * lda;
    for (Index i = 0; i < rows; ++i) {
      c0[i] += a0[i] * b0[k];
      c1[i] += a0[i] * b1[k];
    }
  }
}

}  // namespace

namespace linear_kernels {

// b: scaled by the factor; column j at b + j * inner.
HOVERMODAL_VECTOR_CLONES
void add_product(double* c, Index ldc, const double* a, Index lda, const double* b, Index rows, Index columns,
                 Index inner) {
  double spare[kTileRows];
  for (Index k0 = 0; k0 < inner; k0 += kTileInner) {
    const Index n_inner = std::min(kTileInner, inner - k0);
    for (Index i0 = 0; i0 < rows; i0 += kTileRows) {
      const Index n_rows = std::min(kTileRows, rows - i0);
      const double* tile = a + i0 + k0 * lda;
      for (Index j = 0; j < columns; j += 2) {
        const double* b0 = b + j * inner + k0;
        const bool pair = j + 1 < columns;
        if (!pair) std::fill(spare, spare + n_rows, 0.0);
        add_columns(c + i0 + j * ldc, pair ? c + i0 + (j + 1) * ldc : spare, tile, lda, b0, pair ? b0 + inner : b0,
                    n_rows, n_inner);
      }
    }
  }
}

}  // namespace linear_kernels

namespace {

void add_packed(Ref<MatrixXd> c, const Ref<const MatrixXd>& a, const MatrixXd& packed) {
  linear_kernels::add_product(c.data(), c.outerStride(), a.data(), a.outerStride(), packed.data(), c.rows(), c.cols(),
                              a.cols());
}

// Column by column, for [T; B] with few columns.
bool factor_narrow(Ref<MatrixXd> m) {
  const Index n = m.cols();
  for (Index k = 0; k < n; ++k) {
    const double pivot = m(k, k);
    if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
    m.col(k).tail(m.rows() - k) *= 1.0 / std::sqrt(pivot);
    for (Index j = k + 1; j < n; ++j) m.col(j).tail(m.rows() - j) -= m.col(k).tail(m.rows() - j) * m(j, k);
  }
  return true;
}

bool factor_columns(Ref<MatrixXd> m) {
  const Index n = m.cols();
  if (n <= kLeastColumns) return factor_narrow(m);
  const Index half = (n / 2 + kLeastColumns - 1) / kLeastColumns * kLeastColumns;
  if (!factor_columns(m.leftCols(half))) return false;
  const Index rest = n - half;
  for (Index j = 0; j < rest; j += kStripColumns) {
    const Index width = std::min(kStripColumns, rest - j);
    const Index below = m.rows() - half - j;
    add_product_transposed(m.block(half + j, half + j, below, width), -1.0, m.block(half + j, 0, below, half),
                           m.block(half + j, 0, width, half));
  }
  return factor_columns(m.bottomRightCorner(m.rows() - half, rest));
}

}  // namespace

void add_product(Ref<MatrixXd> c, double factor, const Ref<const MatrixXd>& a, const Ref<const MatrixXd>& b) {
  for (Index j = 0; j < b.cols(); j += kPackedColumns) {
    const Index width = std::min(kPackedColumns, b.cols() - j);
    add_packed(c.middleCols(j, width), a, factor * b.middleCols(j, width));
  }
}

void add_product_transposed(Ref<MatrixXd> c, double factor, const Ref<const MatrixXd>& a,
                            const Ref<const MatrixXd>& b) {
  add_packed(c, a, factor * b.transpose());
}

MatrixXd gram(const Ref<const MatrixXd>& a) {
  const Index n = a.rows();
  MatrixXd out = MatrixXd::Zero(n, n);
  for (Index j = 0; j < n; j += kStripColumns) {
    const Index width = std::min(kStripColumns, n - j);
    add_product_transposed(out.block(j, j, n - j, width), 1.0, a.bottomRows(n - j), a.middleRows(j, width));
  }
  out.triangularView<Eigen::StrictlyUpper>() = out.transpose();
  return out;
}

bool factor_stacked(MatrixXd& m) {
  if (!factor_columns(m)) return false;
  for (Index j = 1; j < m.cols(); ++j) m.col(j).head(j).setZero();
  return true;
}

void divide_by_lower(Ref<MatrixXd> x, const Ref<const MatrixXd>& lower) {
  const Index n = lower.cols();
  if (n <= kLeastColumns) {
    for (Index j = n - 1; j >= 0; --j) {
      for (Index k = j + 1; k < n; ++k) x.col(j) -= x.col(k) * lower(k, j);
      x.col(j) *= 1.0 / lower(j, j);
    }
    return;
  }
  const Index half = (n / 2 + kLeastColumns - 1) / kLeastColumns * kLeastColumns;
  const Index rest = n - half;
  divide_by_lower(x.rightCols(rest), lower.bottomRightCorner(rest, rest));
  add_product(x.leftCols(half), -1.0, x.rightCols(rest), lower.bottomLeftCorner(rest, half));
  divide_by_lower(x.leftCols(half), lower.topLeftCorner(half, half));
}

}  // namespace core
