#pragma once

#include <span>
#include <vector>

namespace core {

struct Band {
  double low_hz = 0.0, high_hz = 0.0;
  [[nodiscard]] double width_hz() const noexcept { return high_hz - low_hz; }
};

// A record reduced to a band and, if wanted, integrated (METHOD.md, 1), that can be evaluated at any instant within the
// record. Edges of width edge_hz() about the band's limits, with half the
// power at the limits. Missing samples (NaN) are bridged by straight lines;
// is_seen() tells where. Does not allocate after construction. One thread.
class BandLimited {
 public:
  // Sample k is at k / rate_hz. n_integrations: 1 from velocity, 2 from acceleration to displacement. Throws
  // std::invalid_argument: fewer than 16 samples, no sample, or a band that is not within 0 < low < high < rate / 2.
  // Without integration low may be 0: only the upper limit counts.
  BandLimited(std::span<const double> samples, double rate_hz, const Band& band, int n_integrations);

  [[nodiscard]] double at(double t_s) const noexcept;        // 0 outside of the record
  [[nodiscard]] double slope_at(double t_s) const noexcept;  // time derivative
  // The record has samples within one period of the band's middle around t_s.
  [[nodiscard]] bool is_seen(double t_s) const noexcept;
  [[nodiscard]] double duration_s() const noexcept { return duration_s_; }
  [[nodiscard]] static double edge_hz(const Band& band, double duration_s) noexcept;

 private:
  double rate_hz_, duration_s_;
  double out_rate_hz_ = 0.0;
  std::vector<double> value_;  // at k / out_rate_hz_ - lead_s_
  double lead_s_ = 0.0;
  std::vector<std::size_t> n_missing_;  // before each sample, cumulated; one more than samples
  double reach_s_ = 0.0;
};

}  // namespace core
