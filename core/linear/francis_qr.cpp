#include "core/linear/francis_qr.h"

#include <algorithm>
#include <cmath>

#include "core/linear/vector_clones.h"
#include "core/types/constants.h"

namespace core {

namespace {

constexpr int kMostSweeps = 60;  // per pair of eigenvalues

// x: last diagonal element, y: the one before, w: product of the two off-diagonal elements.
struct Shift {
  double x, y, w;
};

// First column of (H - s1)(H - s2), scaled.
struct Bulge {
  double p, q, r;
};

class Francis {
 public:
  explicit Francis(RowMatrix& h) : h_(h) {
    for (int i = 0; i < h.n; ++i) {
      for (int j = std::max(0, i - 1); j < h.n; ++j) norm_ += std::abs(h.row(i)[j]);
    }
  }

  bool run(std::vector<std::complex<double>>& values) {
    values.assign(static_cast<std::size_t>(h_.n), 0.0);
    int n_sweeps = 0;
    for (int last = h_.n - 1; last >= 0;) {
      const int first = first_of_block(last);
      if (first >= last - 1) {
        deflate(first, last, values);
        last = first - 1;
        n_sweeps = 0;
        continue;
      }
      if (++n_sweeps > kMostSweeps) return false;
      sweep(first, last, shift(last, n_sweeps));
    }
    return true;
  }

 private:
  // First row of the unreduced block at the end: no subdiagonal element in it is negligible.
  int first_of_block(int last) {
    for (int l = last; l > 0; --l) {
      double size = std::abs(h_.row(l - 1)[l - 1]) + std::abs(h_.row(l)[l]);
      if (size == 0.0) size = norm_;
      if (std::abs(h_.row(l)[l - 1]) <= kEpsilon * size) {
        h_.row(l)[l - 1] = 0.0;
        return l;
      }
    }
    return 0;
  }

  void deflate(int first, int last, std::vector<std::complex<double>>& values) {
    const double x = h_.row(last)[last] + exceptional_;
    std::complex<double>& one = values[static_cast<std::size_t>(last)];
    if (first == last) {
      one = x;
      return;
    }
    std::complex<double>& other = values[static_cast<std::size_t>(last) - 1];
    const double w = h_.row(last)[last - 1] * h_.row(last - 1)[last];
    const double p = 0.5 * (h_.row(last - 1)[last - 1] - h_.row(last)[last]);
    const double q = p * p + w;
    const double z = std::sqrt(std::abs(q));
    if (q >= 0.0) {
      const double far = p + std::copysign(z, p);
      other = x + far;
      one = far != 0.0 ? x - w / far : x + far;
    } else {
      one = {x + p, -z};
      other = std::conj(one);
    }
  }

  Shift shift(int last, int n_sweeps) {
    const double* row = h_.row(last);
    const double* above = h_.row(last - 1);
    if (n_sweeps % 10 != 0) return {row[last], above[last - 1], row[last - 1] * above[last]};
    const double x = row[last];
    exceptional_ += x;
    for (int i = 0; i <= last; ++i) h_.row(i)[i] -= x;
    const double size = std::abs(row[last - 1]) + std::abs(above[last - 2]);
    return {0.75 * size, 0.75 * size, -0.4375 * size * size};
  }

  // First row at which the sweep may start: two consecutive subdiagonal elements are small.
  int start_of_sweep(int first, int last, const Shift& s, Bulge& b) const {
    int m = last - 2;
    for (;; --m) {
      const double *row = h_.row(m), *below = h_.row(m + 1);
      const double z = row[m], r = s.x - z, t = s.y - z;
      b.p = (r * t - s.w) + row[m + 1] * below[m];
      b.q = (below[m + 1] - z - r - t) * below[m];
      b.r = h_.row(m + 2)[m + 1] * below[m];
      if (m == first) break;
      const double u = std::abs(row[m - 1]) * (std::abs(b.q) + std::abs(b.r));
      const double v = std::abs(b.p) * (std::abs(h_.row(m - 1)[m - 1]) + std::abs(z) + std::abs(below[m + 1]));
      if (u <= kEpsilon * v) break;
    }
    const double size = std::abs(b.p) + std::abs(b.q) + std::abs(b.r);
    b = {b.p / size, b.q / size, b.r / size};
    return m;
  }

  void sweep(int first, int last, const Shift& s);

  RowMatrix& h_;
  double norm_ = 0.0;
  double exceptional_ = 0.0;  // sum of the exceptional shifts
};

}  // namespace

namespace linear_kernels {

// Applies I - (1, q, r)^T (x, y, z) to three rows, from their column `begin` on.
HOVERMODAL_VECTOR_CLONES
void reflect_three_rows(double* __restrict h0, double* __restrict h1, double* __restrict h2, int begin, int end,
                        double q, double r, double x, double y, double z) {
  for (int j = begin; j < end; ++j) {
    const double p = h0[j] + q * h1[j] + r * h2[j];
    h0[j] -= p * x;
    h1[j] -= p * y;
    h2[j] -= p * z;
  }
}

}  // namespace linear_kernels

namespace {

void Francis::sweep(int first, int last, const Shift& s) {
  Bulge b{};
  const int m = start_of_sweep(first, last, s, b);
  for (int i = m + 2; i <= last; ++i) {
    h_.row(i)[i - 2] = 0.0;
    if (i > m + 2) h_.row(i)[i - 3] = 0.0;
  }
  for (int k = m; k < last; ++k) {
    const bool three = k + 1 < last;
    double size = 1.0;
    if (k != m) {
      b = {h_.row(k)[k - 1], h_.row(k + 1)[k - 1], three ? h_.row(k + 2)[k - 1] : 0.0};
      size = std::abs(b.p) + std::abs(b.q) + std::abs(b.r);
      if (size == 0.0) continue;
      const double inverse = 1.0 / size;
      b = {b.p * inverse, b.q * inverse, b.r * inverse};
    }
    const double root = std::copysign(std::sqrt(b.p * b.p + b.q * b.q + b.r * b.r), b.p);
    if (root == 0.0) continue;
    if (k != m)
      h_.row(k)[k - 1] = -root * size;
    else if (first != m)
      h_.row(k)[k - 1] = -h_.row(k)[k - 1];
    const double pivot = b.p + root;
    const double by_root = 1.0 / root, by_pivot = 1.0 / pivot;
    const double x = pivot * by_root, y = b.q * by_root, z = b.r * by_root;
    const double q = b.q * by_pivot, r = b.r * by_pivot;
    if (three) {
      linear_kernels::reflect_three_rows(h_.row(k), h_.row(k + 1), h_.row(k + 2), k, last + 1, q, r, x, y, z);
    } else {
      double* h0 = h_.row(k);
      double* h1 = h_.row(k + 1);
      for (int j = k; j <= last; ++j) {
        const double p = h0[j] + q * h1[j];
        h0[j] -= p * x;
        h1[j] -= p * y;
      }
    }
    // From the bottom row upwards, because the next reflection needs the lowest rows.
    if (three) {
      for (int i = std::min(last, k + 3); i >= first; --i) {
        double* h = h_.row(i) + k;
        const double p = x * h[0] + y * h[1] + z * h[2];
        h[0] -= p;
        h[1] -= p * q;
        h[2] -= p * r;
      }
    } else {
      for (int i = last; i >= first; --i) {
        double* h = h_.row(i) + k;
        const double p = x * h[0] + y * h[1];
        h[0] -= p;
        h[1] -= p * q;
      }
    }
  }
}

}  // namespace

bool hessenberg_values(RowMatrix& h, std::vector<std::complex<double>>& values) { return Francis(h).run(values); }

}  // namespace core
