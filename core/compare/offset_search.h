#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "core/compare/band_limited.h"

namespace core {

// An offset between two clocks at which the records correlate more than at its neighbours.
struct CoarseOffset {
  double offset_s = 0.0;
  double evidence = 0.0;  // log-likelihood ratio to no correlation: that of 2 B T independent samples
  bool negative = false;  // the records have opposite signs there
};

// Cross-correlation of a stretch of the camera's record with the whole of the sensor's, normalised by the power of what
// overlaps. Sensor time = camera time + offset.
class OffsetSearch {
 public:
  OffsetSearch(const BandLimited& camera, const BandLimited& sensor, const Band& band, double from_s, double to_s);

  // Local maxima of the evidence, the best one first. Empty: nothing overlaps by half. most_offset_s: 0 = any.
  [[nodiscard]] std::vector<CoarseOffset> peaks(double most_offset_s);
  // Independent trials among the offsets tried by peaks().
  [[nodiscard]] double n_trials() const;

 private:
  // Samples of a record between two instants, and their cumulated squares.
  struct Samples {
    Samples(const BandLimited& record, double from_s, double to_s, double rate_hz);
    [[nodiscard]] double power(std::ptrdiff_t from, std::ptrdiff_t to) const;
    std::vector<double> value, squares{0.0};
  };
  void correlate();
  [[nodiscard]] double product(std::ptrdiff_t lag) const;

  Band band_;
  double rate_hz_, from_s_;
  Samples camera_, sensor_;
  int n_fft_ = 0;
  std::vector<double> correlation_;
  std::size_t n_tried_ = 0;
};

}  // namespace core
