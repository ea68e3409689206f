#pragma once

#include <span>
#include <vector>

namespace core {

// Every `factor`-th sample of a record after a linear-phase low-pass filter (windowed sinc, Kaiser window, 80 dB),
// without delay: sample k of the result is at sample k * factor of the record. Flat within 1e-4 up to kPassband * new
// rate; from there to half the new rate is the filter's transition band, which contains aliases.
//
// NaN = missing; samples outside of the record are missing, too. A result is NaN if its missing inputs have more than 1
// % of the filter's weight (a gap masks its neighbourhood); otherwise the remaining weights are scaled up.
class Decimator {
 public:
  static constexpr double kPassband = 0.4;  // of the new rate

  explicit Decimator(int factor);  // throws std::invalid_argument if factor < 1; 1 copies

  [[nodiscard]] int factor() const noexcept { return factor_; }
  [[nodiscard]] std::vector<double> decimate(std::span<const double> record) const;

 private:
  int factor_;
  int half_ = 0;              // taps on either side
  std::vector<double> taps_;  // 2 * half_ + 1 taps, their sum is 1
  double total_weight_ = 0.0;
};

// The largest factor for which frequencies up to max_frequency_hz lie in the passband; at least 1.
[[nodiscard]] int decimation_factor(double rate_hz, double max_frequency_hz) noexcept;

}  // namespace core
