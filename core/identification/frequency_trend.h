#pragma once

#include <cstddef>
#include <optional>

namespace core {

// Trend of a frequency from successive estimates of one growing record.
//
// An estimate f(T) over the record 0..T averages over it, so successive estimates share their data: each has variance
// c^2 / T, Cov f(T1) f(T2) = c^2 / T2 for T1 < T2, and a line through f(T) would mistake shared noise for a drift.
// Inverting the average gives the contribution of the new data,
//     d_k = (T_k f_k - T_{k-1} f_{k-1}) / (T_k - T_{k-1})   about time (T_k + T_{k-1}) / 2,
// independent from piece to piece, with variance c^2 / (T_k - T_{k-1}) (the difference rule of Hausman 1978,
// Lemma 2.1). Least squares of d on time with weights T_k - T_{k-1} is then the best linear estimate, and a frequency
// that drifts at r Hz/s gives d on a line of slope r exactly. Slope variance: c^2 / sum w (t - mean t)^2.
//
// The caller supplies c^2 = sigma_f^2 T. If the residuals have a larger variance, theirs is used, so that jumping
// estimates (order changes, a weak mode) are not mistaken for a drift. Fixed memory, plain arithmetic.
class FrequencyTrend {
 public:
  // Adds estimates in the order of their records; an estimate whose record did not grow is ignored.
  void add(double frequency_hz, double record_s) noexcept;
  void restart() noexcept { *this = FrequencyTrend(); }

  struct Slope {
    double hz_per_s = 0.0;
    double std_hz_per_s = 0.0;
  };
  // Available from three pieces on. `variance_time` = c^2 in Hz^2 s, > 0.
  [[nodiscard]] std::optional<Slope> slope(double variance_time) const noexcept;
  [[nodiscard]] std::size_t n_pieces() const noexcept { return n_; }

 private:
  std::size_t n_ = 0;
  double first_hz_ = 0.0;  // sums are of differences from it, to preserve precision
  double last_hz_ = 0.0, last_s_ = 0.0;
  double w_ = 0.0, wt_ = 0.0, wd_ = 0.0, wtt_ = 0.0, wtd_ = 0.0, wdd_ = 0.0;
};

}  // namespace core
