#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/geometry/region_shear.h"
#include "core/spectrum/real_fft.h"
#include "core/spectrum/time_grid.h"
#include "core/types/readout.h"
#include "core/types/track.h"

namespace core {

// Readout time of a rolling shutter, estimated online from the tracks: a region that moves at V px per frame is sheared
// by rho V px from the first to the last line (RegionShear), rho = T_r f_s.
//
// V is the derivative of the region's mean motion by a band-limited differentiator (Kaiser window, accurate to 0.44 of
// the rate), in the same frame as the shear: no motion common to the image is needed. Both series are transformed by
// segments with the same window; instantaneous proportionality is preserved by any window, mask and band. Per
// band b and block k of the record, with M the Fisher information of the shears:
//     A = sum Re Z* M V    B = sum Re Z* M S    rho_b = B / A    s_b^2 = mean residual of S - rho V
// and rho = sum B_b / s_b^2 / sum A_b / s_b^2 over the bands that agree. Z is the instrument (two-stage least squares):
// the mean velocity of the other regions, scaled per band to V. Its noise is independent of that of V and S, also where
// the noise of the points of a region is correlated (video codecs), which biases V* M V. With a single region, Z = V
// and the noise of V, which follows from s_b^2 for independent points, is subtracted from A (errors in variables): the
// mean of a region is uncorrelated with its shear. Motion above half the frame rate is
// aliased and has a velocity of wrong sign and size, so its band contradicts the others: the largest set of bands that
// agree within their standard deviations is used, the rest is excluded and counted. The mean of every segment is
// subtracted, which removes errors of the keyframe. Errors proportional to displacement (lens, parallax) are in
// quadrature to velocity. Standard deviation: the larger of that from about twenty contiguous blocks (Student's t) and
// that from s_b^2 alone.
//
// Fixed memory; does not allocate after construction. Deterministic.
class ReadoutEstimator {
 public:
  struct Config {
    RegionShear::Config shear;
    double rate_hz = 0.0;
  };
  // Throws std::invalid_argument: a rate that is not positive, or a point without a region.
  ReadoutEstimator(const Config& config, const TrackFrame& keyframe);

  // Adds one frame, in order. Gaps of a few frames are interpolated, longer ones split the record.
  void update(const TrackFrame& tracks) noexcept;
  // Estimate over all segments so far; updated when a segment is complete.
  [[nodiscard]] const ReadoutEstimate& estimate() const noexcept { return estimate_; }

  static constexpr std::size_t kMaxBands = 20;
  static constexpr std::size_t kMaxBlocks = 20;
  struct Sums {                                          // sums of one band
    double velocity = 0.0, cross = 0.0, shear = 0.0;     // V* M V, V* M S, S* M S
    double on_velocity = 0.0, on_cross = 0.0, on = 0.0;  // Z* M V, Z* M S, Z* M Z before scaling; 0: a single region
    double velocity_noise = 0.0;                         // of `velocity` per unit of s^2
    double n_values = 0.0;                               // degrees of freedom of `shear`, times 1 per unit of s^2

    void add(const Sums& more) noexcept;
  };

 private:
  static constexpr int kHalf = 16;        // half length of the differentiator
  static constexpr int kMostBridged = 5;  // frames
  static constexpr int kRing = 2 * kHalf + 1 + kMostBridged;
  using Block = std::array<Sums, kMaxBands>;

  void push_cell(bool seen) noexcept;
  void bridge(std::size_t region) noexcept;
  void clear_ring() noexcept;
  void differentiate() noexcept;
  void take_segment() noexcept;
  void transform_channels() noexcept;
  void add_bins() noexcept;
  void make_instruments(std::size_t bin) noexcept;
  void close_segment() noexcept;
  [[nodiscard]] ReadoutEstimate combined() const noexcept;
  [[nodiscard]] RegionShear::Sample& at(std::int64_t cell) noexcept {
    return ring_[static_cast<std::size_t>(cell % kRing)];
  }

  RegionShear shear_;
  std::size_t n_channels_;
  double rate_hz_;
  TimeGrid grid_;
  std::array<double, kHalf + 1> taps_{};
  std::array<RegionShear::Sample, kRing> ring_;
  std::int64_t n_cells_ = 0;             // cells pushed since the ring was cleared
  std::vector<std::int64_t> last_seen_;  // per region, cell; -1 = none
  RegionShear::Sample frame_;

  int segment_;
  std::size_t n_bands_ = 0;
  std::array<std::size_t, kMaxBands + 1> first_bin_{};
  std::vector<double> window_, window_sum_;  // segment; per channel: energy of the window over observed cells
  std::vector<double> velocity_, shear_px_;  // channels x segment, oldest first
  std::vector<std::uint8_t> seen_;           // regions x segment
  int filled_ = 0;
  RealFft fft_;
  std::vector<double> work_;
  std::vector<std::complex<double>> velocity_bins_, shear_bins_;  // channels x bins
  std::vector<std::complex<double>> instrument_;                  // channels, of one bin
  std::vector<double> velocity_gain_;                             // per bin: inverse gain of the differentiator
  std::vector<double> noise_gain_;                                // per bin: velocity noise for unit white noise

  std::array<Block, kMaxBlocks> blocks_{};
  std::size_t n_blocks_ = 0, segments_in_last_ = 0, segments_per_block_ = 1;
  std::size_t n_segments_ = 0;
  ReadoutEstimate estimate_;
};

}  // namespace core
